"""What a mesh carries beside positions."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple

import numpy as np

from ._indices import frame_index, frame_indices
from ._types import AnyArray, IndexArray

if TYPE_CHECKING:
    from ._sequence import Sequence

SEMANTICS = ("generic", "texture_coordinate", "normal", "tangent", "colour", "velocity", "material", "group", "index")
DOMAINS = ("vertex", "corner", "face", "shot")
DTYPES = (np.float32, np.uint8, np.uint16, np.int32, np.uint8, np.uint16)
NORMALISED = (False, False, False, False, True, True)


@dataclass(frozen=True)
class AttributeInfo:
    """An attribute of a shot, without its values."""

    name: str
    domain: str  #: what there is one value of: "vertex", "corner" (of a face), "face" or "shot"
    semantic: str  #: "generic", "texture_coordinate", "normal", "tangent", "colour", "velocity", "material", ...
    dtype: "np.dtype[Any]"  #: float32, uint8, uint16 or int32
    normalised: bool  #: numbers of an integer dtype stand for parts of its largest: 255 of uint8 is 1
    channels: int  #: numbers per element, 1 to 16
    animated: bool  #: values differ from frame to frame
    computed: bool  #: normals that follow from the positions of each frame
    bytes: int  #: in the file
    shot: int
    index: int  #: among the attributes of its shot


class Attributes(Mapping[str, AttributeInfo]):
    """Attributes of a shot by name. Of several with one name, such as a field of vertices and one of faces, `[name]`
    is the first; `all` has each of them."""

    def __init__(self, infos: Iterable[AttributeInfo]) -> None:
        self.all: Tuple[AttributeInfo, ...] = tuple(infos)
        self._first = {info.name: info for info in reversed(self.all)}

    def __getitem__(self, name: str) -> AttributeInfo:
        return self._first[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(info.name for info in self.all))

    def __len__(self) -> int:
        return len(self._first)

    def find(self, name: str, domain: Optional[str] = None) -> Optional[AttributeInfo]:
        """The first of that name and, unless it is None, domain."""
        return next((a for a in self.all if a.name == name and domain in (None, a.domain)), None)

    def __repr__(self) -> str:
        return f"<reeb.Attributes: {', '.join(self) or 'none'}>"


class Polygons:
    """Faces of any number of corners; a sequence of uint32 arrays, the vertices of each face."""

    def __init__(self, sizes: IndexArray, corners: IndexArray) -> None:
        self.sizes = sizes  #: uint32 [faces]: the number of corners of each
        self.corners = corners  #: uint32 [corners]: the vertices of all corners, one face after another
        self._ends = np.cumsum(sizes, dtype=np.int64)

    def __len__(self) -> int:
        return len(self.sizes)

    def __getitem__(self, face: int) -> IndexArray:
        face = frame_index(face, len(self), "face")
        end = int(self._ends[face])
        return self.corners[end - int(self.sizes[face]):end]

    def __iter__(self) -> Iterator[IndexArray]:
        return (self[face] for face in range(len(self)))

    def __repr__(self) -> str:
        return f"<reeb.Polygons: {len(self)} faces, {len(self.corners)} corners>"


@dataclass(frozen=True)
class Resource:
    """A file that travels along, such as a texture."""

    name: str
    media_type: str
    data: bytes


class AttributeReader:
    """The values of one attribute, by frame: `reader[i]` is an array [elements] or, with several channels,
    [elements, channels]; `reader[a:b]` has the frames as its first dimension. Elements are the vertices, the corners
    (as of `Sequence.polygons`), the faces or the shot. In a sequence of several shots it is the attribute of that name
    of each of them.
    """

    def __init__(self, sequence: "Sequence", name: str, infos: Iterable[AttributeInfo]) -> None:
        self._sequence = sequence
        self._infos = {info.shot: info for info in infos}
        self.name = name

    @property
    def info(self) -> AttributeInfo:
        """Of the first shot that has the attribute."""
        return next(iter(self._infos.values()))

    @cached_property
    def names(self) -> List[str]:
        """What the values of a material or group stand for: `names[value]`."""
        info = self.info
        return self._sequence._stream.names(self._sequence.shots[info.shot]._frame, info.index)

    def __len__(self) -> int:
        return len(self._sequence)

    def __getitem__(self, frames: Any) -> AnyArray:
        return self.values(frames)

    def values(self, frames: Any = slice(None), *, out: Optional[AnyArray] = None) -> AnyArray:
        """As indexing; `out`: a contiguous array of the shape and dtype of the result, written to and given back."""
        numbers, single = frame_indices(frames, len(self))
        if len(numbers) == 0:
            first = next(iter(self._infos.values()))
            return np.empty((0, *self._shape(first)), first.dtype)
        info = self._info_of(numbers)
        shape = self._shape(info) if single else (len(numbers), *self._shape(info))
        if out is None:
            out = np.empty(shape, info.dtype)
        elif out.shape != shape or out.dtype != info.dtype or not out.flags.c_contiguous or not out.flags.writeable:
            raise ValueError(f"out: has to be a writeable, contiguous {info.dtype} array {list(shape)}")
        rows = out.reshape(len(numbers), self._elements(info), info.channels)
        for row, number in zip(rows, numbers):
            self._sequence._stream.values(int(number), info.index, _as_bytes(row))
        return out

    def _info_of(self, numbers: AnyArray) -> AttributeInfo:
        shots = self._sequence._shots_with(numbers)
        infos = [self._infos.get(shot) for shot in shots]
        for shot, info in zip(shots, infos):
            if info is None:
                raise KeyError(f"shot {shot} has no attribute {self.name!r}")
        found = [info for info in infos if info is not None]
        if len({(self._shape(info), info.dtype) for info in found}) > 1 or len({info.index for info in found}) > 1:
            raise ValueError(f"attribute {self.name!r} differs between shots {shots[0]} and {shots[-1]}: "
                             "ask for the frames of one shot")
        return found[0]

    def _elements(self, info: AttributeInfo) -> int:
        return self._sequence.shots[info.shot].element_count(info.domain)

    def _shape(self, info: AttributeInfo) -> Tuple[int, ...]:
        elements = self._elements(info)
        return (elements,) if info.channels == 1 else (elements, info.channels)

    def __repr__(self) -> str:
        info = self.info
        kind = "computed" if info.computed else "animated" if info.animated else "static"
        return f"<reeb.AttributeReader {self.name!r}: {kind}, {list(self._shape(info))} {info.dtype} per {info.domain}>"


def _as_bytes(values: AnyArray) -> "np.ndarray[Any, np.dtype[np.uint8]]":
    """The same memory as [elements, bytes]."""
    return values.view(np.uint8).reshape(values.shape[0], -1)


def info_of(raw: Dict[str, Any], shot: int) -> AttributeInfo:
    type_ = raw["type"]
    return AttributeInfo(name=raw["name"], domain=DOMAINS[raw["domain"]], semantic=SEMANTICS[raw["semantic"]],
                         dtype=np.dtype(DTYPES[type_]), normalised=NORMALISED[type_], channels=raw["channels"],
                         animated=raw["animated"], computed=raw["computed"], bytes=raw["bytes"], shot=shot,
                         index=raw["index"])
