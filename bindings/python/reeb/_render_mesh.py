"""The mesh as graphics interfaces take it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, List, Optional, Sequence as Items, Tuple, Union

import numpy as np

from . import _core
from ._attributes import _as_bytes
from ._indices import frame_index
from ._types import AnyArray, FloatArray, IndexArray

if TYPE_CHECKING:
    from ._sequence import Sequence

_SEAMS = ("texture_coordinate", "normal", "tangent", "colour")


@dataclass(frozen=True)
class MaterialRange:
    """Triangles `first` .. `first + count - 1`, which have one material."""

    material: int  #: value of the attribute that triangles are sorted by; -1 where there is none
    name: Optional[str]  #: what it is called
    first: int
    count: int


class RenderMesh:
    """One vertex for every combination of a vertex and what its corners have, and triangles sorted by material.
    Vertices without a face are left out. Made by `Sequence.render_mesh`; of no use once the sequence is closed.
    """

    def __init__(self, sequence: "Sequence", frame: int, split_by: Optional[Items[str]]) -> None:
        self._sequence = sequence
        frame = frame_index(frame, len(sequence))
        shot = sequence.shots[sequence.shot_of(frame)]
        if split_by is None:
            split_by = [a.name for a in shot.attributes.all if a.domain == "corner" and a.semantic in _SEAMS]
        missing = [name for name in split_by if name not in shot.attributes]
        if missing:
            raise KeyError(f"split_by: there is no attribute {missing[0]!r}")
        self.shot = shot
        self._mesh = _core.RenderMesh(sequence._stream, frame, [shot.attributes[name].index for name in split_by])
        info = self._mesh.info()
        self.triangles: IndexArray = info["triangles"]  #: uint32 [triangles, 3]: render vertices
        self.source_vertices: IndexArray = info["source_vertices"]  #: uint32 [vertices]: vertex of the shot of each
        self.source_corners: IndexArray = info["source_corners"]  #: uint32 [vertices]: a corner that has its values
        self.source_faces: IndexArray = info["source_faces"]  #: uint32 [triangles]: face of the shot of each
        names = sequence._stream.names(frame, info["material_attribute"]) if info["material_attribute"] >= 0 else []
        self.ranges: List[MaterialRange] = [
            MaterialRange(material, names[material] if 0 <= material < len(names) else None, first, count)
            for material, first, count in info["ranges"]
        ]  #: of the materials, in the order of the triangles

    @property
    def vertex_count(self) -> int:
        return len(self.source_vertices)

    def positions(self, frame: Union[int, float], *, out: Optional[FloatArray] = None) -> FloatArray:
        """float32 [vertices, 3] in a frame, or, of a broken number, between two; of the mesh's shot."""
        positions = self._room(out, "out")
        self._mesh.between(self._check(frame), positions)
        return positions

    def positions_and_normals(self, frame: Union[int, float]) -> Tuple[FloatArray, FloatArray]:
        """The same with unit normals that are smooth at every vertex of the shot."""
        positions, normals = self._room(None, "out"), self._room(None, "normals")
        self._mesh.between(self._check(frame), positions, normals)
        return positions, normals

    def values(self, name: str, frame: int) -> AnyArray:
        """Values of an attribute in a frame: of each render vertex, or, where it is one of faces, of each triangle;
        [elements] or, with several channels, [elements, channels]."""
        info = self.shot.attributes[name]
        count = {"face": len(self.triangles), "shot": 1}.get(info.domain, self.vertex_count)
        values: AnyArray = np.empty((count, info.channels), info.dtype)
        self._mesh.values(frame_index(frame, len(self._sequence)), info.index, _as_bytes(values))
        return values[:, 0] if info.channels == 1 else values

    def _check(self, frame: Any) -> float:
        position = float(frame)
        if not self.shot.first_frame <= position <= self.shot.end_frame - 1:
            raise IndexError(f"frame {frame} is not in the mesh's shot, frames {self.shot.first_frame} to "
                             f"{self.shot.end_frame - 1}")
        return position

    def _room(self, out: Optional[FloatArray], what: str) -> FloatArray:
        from ._sequence import room_for
        return room_for(out, (self.vertex_count, 3), what)

    def __repr__(self) -> str:
        return f"<reeb.RenderMesh: {self.vertex_count} vertices, {len(self.triangles)} triangles>"
