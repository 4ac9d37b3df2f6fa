"""A stream that is open for reading."""

import atexit
import sys
import weakref
from dataclasses import dataclass, field
from functools import cached_property
from types import TracebackType
from typing import Any, Dict, Iterator, List, Optional, Sequence as Items, Tuple, Type, Union

import numpy as np

from . import _core
from ._attributes import AttributeInfo, AttributeReader, Attributes, Polygons, Resource, info_of
from ._indices import frame_index, frame_indices, runs
from ._render_mesh import RenderMesh
from ._types import AnyArray, FloatArray, IndexArray

_FRAMES_AT_ONCE = 16  # decode in half the time of one after another

# A thread that decodes ahead from a Python object must end before the interpreter does.
_open_streams: "weakref.WeakSet[_core.Stream]" = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    for stream in list(_open_streams):
        stream.close()


def room_for(out: Optional[FloatArray], shape: Tuple[int, ...], what: str = "out") -> FloatArray:
    """A new array, or the caller's if it is as it must be."""
    if out is None:
        return np.empty(shape, np.float32)
    if not isinstance(out, np.ndarray) or out.dtype != np.float32 or out.shape != shape:
        given = f"{out.dtype} {list(out.shape)}" if isinstance(out, np.ndarray) else type(out).__name__
        raise ValueError(f"{what}: has to be a float32 array {list(shape)}, not {given}")
    if not out.flags.c_contiguous or not out.flags.writeable:
        raise ValueError(f"{what}: has to be contiguous and writeable")
    return out


@dataclass(frozen=True)
class Shot:
    """A run of frames with one connectivity."""

    index: int
    first_frame: int
    end_frame: int  #: one past its last frame that can be decoded
    vertex_count: int
    face_count: int
    order_kept: bool  #: vertices come in the order of what was encoded
    attributes: Attributes
    _stream: "_core.Stream" = field(repr=False)
    _frame: int = field(repr=False)  # the first that can be decoded

    @property
    def frames(self) -> range:
        return range(self.first_frame, self.end_frame)

    @cached_property
    def faces(self) -> IndexArray:
        """uint32 [triangles, 3]: vertices of each; a polygon is a fan around its first corner."""
        faces: IndexArray = self._stream.triangles(self._frame)
        faces.flags.writeable = False
        return faces

    @cached_property
    def polygons(self) -> Polygons:
        """The faces as they were encoded."""
        return Polygons(*self._stream.polygons(self._frame))

    def element_count(self, domain: str) -> int:
        """How many values of an attribute there are: vertices, corners, faces, or 1."""
        if domain == "corner":
            return len(self.polygons.corners)
        return {"vertex": self.vertex_count, "face": self.face_count, "shot": 1}[domain]


def _shots_of(stream: "_core.Stream") -> List[Shot]:
    """Those whose mesh is not lost; groups and attributes count the lost ones, too."""
    raw = stream.shots()
    attributes = stream.attributes()
    out: List[Shot] = []
    for i, (first, end, vertices, faces, kept) in enumerate(raw):
        groups = [(number, frame) for frame, _, number, _ in stream.groups() if first <= frame < max(end, first + 1)]
        number, frame = min(groups, default=(i, first))
        infos = Attributes(info_of(a, shot=i) for a in attributes if a["shot"] == number)
        out.append(Shot(i, first, end, vertices, faces, kept, infos, stream, frame))
    return out


class Sequence:
    """Frames of an animated mesh: `reeb.open` gives one.

    `seq[i]` is a frame, float32 [vertices, 3]; a slice, a list or array of frames, or a mask gives
    [frames, vertices, 3]. Iteration goes through all frames and decodes each group once, the next one ahead; the
    arrays that it gives share memory with up to 15 others, so copy those that are to be kept. Calls may come from any
    thread; those on one sequence take turns, without the interpreter's lock.
    """

    def __init__(self, stream: "_core.Stream") -> None:
        self._stream = stream
        _open_streams.add(stream)
        info = stream.info()
        self._count: int = info["frame_count"]
        self.total_frames: int = info["total_frames"]  #: of the sequence as it was encoded
        self.truncated: bool = info["truncated"]  #: the file ends early
        self.fps: Optional[float] = info["frame_rate"] or None  #: frames per second; None where unknown
        self.start_time: float = info["start_time"]  #: of the first frame, in frames
        self.format_version: int = info["format_version"]
        self.file_bytes: int = info["file_bytes"]
        self.metadata: Dict[str, str] = stream.metadata()  #: free keys and values
        self.gaps: List[range] = [range(first, first + count) for first, count in stream.gaps()]  #: damaged or cut off
        self.shots: List[Shot] = _shots_of(stream)  #: runs of frames with one connectivity

    # -- what it holds

    def __len__(self) -> int:
        """Frames, up to the last one that can be decoded."""
        return self._count

    @property
    def times(self) -> Optional["np.ndarray[Any, np.dtype[np.float64]]"]:
        """float64 [frames]: seconds from the first frame on; None where the frame rate is unknown."""
        return None if self.fps is None else np.arange(self._count) / self.fps

    @property
    def vertex_count(self) -> int:
        """Of the only shot."""
        return self._only_shot("vertex_count").vertex_count

    @property
    def faces(self) -> IndexArray:
        """uint32 [triangles, 3]: vertices of each, of the only shot; a polygon is a fan around its first corner."""
        return self._only_shot("faces").faces

    @property
    def polygons(self) -> Polygons:
        """The faces of the only shot as they were encoded, a sequence of arrays of vertices."""
        return self._only_shot("polygons").polygons

    @property
    def attributes(self) -> Attributes:
        """By name, those of the only shot; values come by `attribute`."""
        return self._only_shot("attributes").attributes

    @cached_property
    def resources(self) -> Dict[str, Resource]:
        """Files that travel along, by name."""
        listed = self._stream.resources()
        return {name: Resource(name, kind, self._stream.resource(i)) for i, (name, kind) in enumerate(listed)}

    @cached_property
    def groups(self) -> List[range]:
        """Frames of each group: what decodes together."""
        return [range(first, first + count) for first, count, _, _ in self._stream.groups()]

    @cached_property
    def group_bounds(self) -> Optional[FloatArray]:
        """float32 [groups, 2, 3]: lowest and highest corner of the box around the positions of each; None where the
        file does not tell."""
        boxes = [self._stream.bounds(group) for group in range(len(self.groups))]
        return None if not boxes or any(box is None for box in boxes) else np.stack([b for b in boxes if b is not None])

    @property
    def bounds(self) -> Optional[FloatArray]:
        """float32 [2, 3]: lowest and highest corner of the box around all positions; None where the file does not
        tell."""
        boxes = self.group_bounds
        return None if boxes is None else np.stack((boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)))

    def shot_of(self, frame: int) -> int:
        """The index of the shot that holds a frame."""
        return int(self._shots_with(np.array([frame_index(frame, self._count)]))[0])

    # -- positions

    def __getitem__(self, frames: Any) -> FloatArray:
        return self.positions(frames)

    def positions(self, frames: Any = slice(None), vertices: Any = None, *,
                  out: Optional[FloatArray] = None) -> FloatArray:
        """Positions of frames, as indexing gives them.

        frames: an index, which gives [vertices, 3]; a slice, indices in any order or a mask, which give
            [frames, vertices, 3].
        vertices: of which the positions are wanted: what may index a NumPy array; None = all.
        out: a contiguous float32 array of the shape of the result, which is written to, without a copy where
            `vertices` is None, and given back.
        """
        numbers, single = frame_indices(frames, self._count)
        shot = self._one_shot(numbers)
        shape = (len(numbers), shot.vertex_count, 3)
        if vertices is not None:
            return self._some_vertices(numbers, single, shot, vertices, out)
        result = room_for(out, shape[1:] if single else shape)
        rows = result.reshape(shape)
        for place, first, count in runs(numbers):
            self._stream.frames(first, rows[place:place + count])
        return result

    def __iter__(self) -> Iterator[FloatArray]:
        pool: List[FloatArray] = []
        for shot in self.shots:
            for first in range(shot.first_frame, shot.end_frame, _FRAMES_AT_ONCE):
                count = min(_FRAMES_AT_ONCE, shot.end_frame - first)
                block = _free_block(pool, (_FRAMES_AT_ONCE, shot.vertex_count, 3))
                rows = block[:count]
                self._stream.frames(first, rows)
                yield from rows
                del block, rows

    def at(self, seconds: float, *, loop: bool = False, out: Optional[FloatArray] = None) -> FloatArray:
        """float32 [vertices, 3]: the pose at a time after the first frame, linear between two frames; held at the
        ends, or, with `loop`, around and around. ValueError where the frame rate is unknown."""
        if self.fps is None:
            raise ValueError("the frame rate is unknown; use seq.between(position in frames)")
        if not np.isfinite(seconds):
            raise ValueError(f"seconds: {seconds} is not finite")
        return self.between(self._stream.position_of_time(seconds, loop), out=out)

    def between(self, position: float, *, out: Optional[FloatArray] = None) -> FloatArray:
        """The same at a position in frames, 0 to len(seq) - 1."""
        if not 0 <= position <= self._count - 1:
            raise IndexError(f"position {position} is out of range: frames go from 0 to {self._count - 1}")
        result = room_for(out, (self.shots[self.shot_of(int(position))].vertex_count, 3))
        self._stream.between(position, result)
        return result

    def normals(self, frame: int) -> FloatArray:
        """float32 [vertices, 3]: unit normals of a frame, those of the triangles around weighted by area; (0, 0, 0)
        at a vertex without any. Normals that were encoded are an attribute."""
        frame = frame_index(frame, self._count)
        shape = (self.shots[self.shot_of(frame)].vertex_count, 3)
        positions, normals = np.empty(shape, np.float32), np.empty(shape, np.float32)
        self._stream.frame(frame, positions, normals)
        return normals

    # -- the rest

    def attribute(self, name: Union[str, AttributeInfo], domain: Optional[str] = None) -> AttributeReader:
        """The values of an attribute, by frame: `seq.attribute("pressure")[3]`. Of several with one name the first,
        or that of a domain, or the one of which this is the info. KeyError where there is none."""
        if isinstance(name, AttributeInfo):
            return AttributeReader(self, name.name, [name])
        found = [shot.attributes.find(name, domain) for shot in self.shots]
        infos = [info for info in found if info is not None]
        if not infos:
            known = sorted({info.name for shot in self.shots for info in shot.attributes.all})
            raise KeyError(f"there is no attribute {name!r}{f' of {domain}' if domain else ''}; there are "
                           f"{', '.join(known) or 'none'}")
        return AttributeReader(self, name, infos)

    def render_mesh(self, split_by: Optional[Items[str]] = None, *, frame: int = 0) -> RenderMesh:
        """The mesh of a frame's shot for graphics interfaces, its vertices split where any of the attributes
        `split_by` differs at the corners of a vertex; None = texture coordinates, normals, tangents and colours."""
        return RenderMesh(self, frame, split_by)

    @property
    def stats(self) -> Dict[str, Union[int, float]]:
        """Frames given, groups decoded in all and ahead, the longest wait in seconds, bytes held now and at most."""
        return self._stream.stats()

    def cancel(self) -> None:
        """Ends the calls that other threads have running, soon, with CancelledError."""
        self._stream.cancel()

    def close(self) -> None:
        """Ends the stream; what was given stays. Calls afterwards raise ValueError."""
        self._stream.close()

    @property
    def closed(self) -> bool:
        return self._stream.closed

    def __enter__(self) -> "Sequence":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def __repr__(self) -> str:
        vertices = " or ".join(sorted({f"{shot.vertex_count:,}" for shot in self.shots})) or "no"
        rate = "" if self.fps is None else f", {self.fps:g} frames per second"
        return f"<reeb.Sequence: {self._count:,} frames of {vertices} vertices{rate}, {self.file_bytes:,} bytes>"

    def _repr_png_(self) -> Optional[bytes]:
        """What a notebook shows."""
        from ._picture import picture
        return picture(self)

    # -- within the package

    def _only_shot(self, what: str) -> Shot:
        if len(self.shots) != 1:
            raise ValueError(f"there are {len(self.shots)} shots, each with its own {what}: ask seq.shots[i].{what}")
        return self.shots[0]

    def _shots_with(self, numbers: AnyArray) -> List[int]:
        """The shots that hold these frames, ascending."""
        firsts = [shot.first_frame for shot in self.shots]
        return [int(i) for i in np.unique(np.searchsorted(firsts, numbers, side="right") - 1)]

    def _one_shot(self, numbers: AnyArray) -> Shot:
        """The shot of these frames; any of several whose frames have the same shape."""
        if len(numbers) == 0:
            return self.shots[0]
        shots = [self.shots[i] for i in self._shots_with(numbers)]
        if len({shot.vertex_count for shot in shots}) > 1:
            raise ValueError(f"frames: they are of shots {shots[0].index} to {shots[-1].index}, whose numbers of "
                             f"vertices differ; ask for those of one: seq[seq.shots[{shots[0].index}].frames]")
        return shots[0]

    def _some_vertices(self, numbers: AnyArray, single: bool, shot: Shot, vertices: Any,
                       out: Optional[FloatArray]) -> FloatArray:
        try:
            chosen = np.arange(shot.vertex_count)[vertices]
        except IndexError as error:
            raise IndexError(f"vertices: {error}") from None
        if chosen.ndim != 1:
            raise IndexError("vertices: a slice, indices or a mask are allowed")
        shape = (len(numbers), len(chosen), 3)
        result = room_for(out, shape[1:] if single else shape)
        rows = result.reshape(shape)
        block = np.empty((min(_FRAMES_AT_ONCE, len(numbers)), shot.vertex_count, 3), np.float32)
        for place, first, count in runs(numbers):
            for done in range(0, count, _FRAMES_AT_ONCE):
                part = min(_FRAMES_AT_ONCE, count - done)
                self._stream.frames(first + done, block[:part])
                rows[place + done:place + done + part] = block[:part, chosen]
        return result


def _free_block(pool: List[FloatArray], shape: Tuple[int, ...]) -> FloatArray:
    """Memory of frames that nobody holds any more; fresh memory takes as long as decoding into it."""
    held = 2  # by the pool and as the argument of getrefcount
    for i in range(len(pool)):
        if pool[i].shape == shape and sys.getrefcount(pool[i]) == held:
            return pool[i]
    del pool[1:]
    pool.insert(0, np.empty(shape, np.float32))
    return pool[0]
