"""Meshes of other libraries. Each is imported when it is asked for: pip install 'reeb[trimesh,pyvista,open3d]'."""

from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Tuple

import numpy as np

from ._input import Attribute, AttributeLike
from ._sequence import Sequence
from ._types import FloatArray, IndexArray

if TYPE_CHECKING:
    import open3d
    import pyvista
    import trimesh


def from_trimesh(meshes: "Iterable[trimesh.Trimesh]") -> Tuple[FloatArray, IndexArray, Dict[str, AttributeLike]]:
    """Positions [frames, vertices, 3], faces and attributes for `encode`, of one mesh for each frame, or of one.

    Vertex and face attributes of the first mesh come along, animated where all frames have them and they change; so do
    its texture coordinates.
    """
    from trimesh import Trimesh

    frames = [meshes] if isinstance(meshes, Trimesh) else list(meshes)
    if not frames:
        raise ValueError("meshes: there is none")
    faces = np.asarray(frames[0].faces)
    for i, mesh in enumerate(frames):
        if mesh.vertices.shape != frames[0].vertices.shape or not np.array_equal(mesh.faces, faces):
            raise ValueError(f"meshes: frame {i} has other faces or vertices than frame 0")
    positions = np.stack([np.asarray(mesh.vertices, np.float32) for mesh in frames])
    attributes: Dict[str, AttributeLike] = {}
    for domain, kept in (("vertex", "vertex_attributes"), ("face", "face_attributes")):
        for name in getattr(frames[0], kept):
            values = [np.asarray(getattr(mesh, kept)[name]) for mesh in frames if name in getattr(mesh, kept)]
            attributes[name] = over_time(values, domain, len(frames))
    uv = getattr(frames[0].visual, "uv", None)
    if uv is not None:
        attributes["uv"] = Attribute(np.asarray(uv), "vertex", semantic="texture_coordinate")
    return positions, faces.astype(np.uint32), attributes


def over_time(values: List[Any], domain: str, frames: int, name: str = "") -> Attribute:
    """Animated where there is one for each frame and they differ."""
    animated = len(values) == frames and any(not np.array_equal(v, values[0]) for v in values[1:])
    return Attribute(np.stack(values) if animated else values[0], domain, animated=animated)


def to_trimesh(sequence: Sequence, frame: int = 0) -> "trimesh.Trimesh":
    """A frame, its vertices and triangles in order, with the attributes of vertices, and of faces where all are
    triangles."""
    import trimesh

    shot = sequence.shots[sequence.shot_of(frame)]
    mesh = trimesh.Trimesh(sequence[frame], shot.faces, process=False)
    for info in shot.attributes.all:
        if info.domain == "vertex":
            mesh.vertex_attributes[info.name] = sequence.attribute(info)[frame]
        elif info.domain == "face" and len(shot.faces) == shot.face_count:
            mesh.face_attributes[info.name] = sequence.attribute(info)[frame]
    return mesh


def to_open3d(sequence: Sequence, frame: int = 0) -> "open3d.geometry.TriangleMesh":
    """A frame as Open3D's triangle mesh."""
    import open3d

    shot = sequence.shots[sequence.shot_of(frame)]
    return open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(sequence[frame].astype(float)),
                                        open3d.utility.Vector3iVector(shot.faces.astype(np.int32)))


class Animated:
    """A sequence as a PyVista mesh that changes in place:

        view = reeb.to_pyvista(seq)
        plotter.add_mesh(view.mesh, scalars="pressure")
        view.set_time(1.5)

    The mesh object, its cells and its arrays stay the same ones; points and animated fields get other values.
    """

    def __init__(self, sequence: Sequence, shot: int = 0) -> None:
        import pyvista

        self._sequence, self._shot = sequence, sequence.shots[shot]
        first = self._shot.first_frame
        polygons = self._shot.polygons
        sizes = polygons.sizes.astype(np.int64)
        cells = np.insert(polygons.corners.astype(np.int64), np.cumsum(sizes) - sizes, sizes)
        self._points = sequence[first]
        self.mesh: "pyvista.PolyData" = pyvista.PolyData(self._points, cells)
        self._fields = {info: sequence.attribute(info)[first] for info in self._shot.attributes.all
                        if info.domain in ("vertex", "face")}
        for info, values in self._fields.items():
            data = self.mesh.point_data if info.domain == "vertex" else self.mesh.cell_data
            data[info.name] = values
        self.frame: float = first

    def set_time(self, seconds: float, *, loop: bool = False) -> None:
        """Shows a time after the first frame of the sequence; points are linear between two frames, fields those of
        the earlier one."""
        if self._sequence.fps is None:
            raise ValueError("the frame rate is unknown; use set_frame")
        self.set_frame(self._sequence._stream.position_of_time(seconds, loop))

    def set_frame(self, frame: float) -> None:
        """Shows a position in frames, within the shot."""
        shot = self._shot
        if not shot.first_frame <= frame <= shot.end_frame - 1:
            raise IndexError(f"frame {frame} is not in the shot, frames {shot.first_frame} to {shot.end_frame - 1}")
        self.frame = frame
        self.mesh.points[:] = self._sequence.between(frame, out=self._points)
        for info in self._fields:
            if info.animated:
                data = self.mesh.point_data if info.domain == "vertex" else self.mesh.cell_data
                data[info.name][:] = self._sequence.attribute(info)[int(frame)]
        self.mesh.Modified()


def to_pyvista(sequence: Sequence, shot: int = 0) -> Animated:
    """A shot as a PyVista mesh, which `set_time` and `set_frame` of what is given change in place: its points, and its
    fields of vertices and faces as point and cell data."""
    return Animated(sequence, shot)
