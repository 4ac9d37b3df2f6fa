"""Meshes of Universal Scene Description: pip install 'reeb[usd]'."""

import os
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from ._attributes import AttributeInfo, Polygons
from ._input import Attribute, AttributeLike
from ._neighbours import over_time
from ._sequence import Sequence
from ._types import FloatArray, Path

_INTERPOLATIONS = {"vertex": "vertex", "corner": "faceVarying", "face": "uniform", "shot": "constant"}
_DOMAINS = {"vertex": "vertex", "varying": "vertex", "faceVarying": "corner", "uniform": "face", "constant": "shot"}


def from_usd(path: Path, prim: str) -> Tuple[FloatArray, Polygons, Dict[str, AttributeLike], float]:
    """Positions [frames, vertices, 3], faces, attributes and frames per second of a mesh, for `encode`.

    prim: path of the mesh in the stage, such as "/World/Cloth". Frames are the time samples of its points, in the
    prim's own space; primvars of numbers and normals come along, animated where they have samples. ValueError where the
    faces change, or a primvar cannot be kept.
    """
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(os.fspath(path))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(prim))
    if not mesh:
        raise ValueError(f"prim: {prim!r} is no mesh of {os.fspath(path)}")
    times: List[Any] = list(mesh.GetPointsAttr().GetTimeSamples()) or [Usd.TimeCode.Default()]
    faces = _faces_at(mesh, times[0])
    for time in times:
        other = _faces_at(mesh, time)
        if not (np.array_equal(other.sizes, faces.sizes) and np.array_equal(other.corners, faces.corners)):
            raise ValueError(f"{prim}: other faces at time {time} than at {times[0]}")
    positions = np.stack([np.asarray(mesh.GetPointsAttr().Get(time), np.float32) for time in times])
    attributes: Dict[str, AttributeLike] = {}
    for primvar in UsdGeom.PrimvarsAPI(mesh).GetPrimvarsWithAuthoredValues():
        attribute = _values_of(primvar.ComputeFlattened, primvar.GetInterpolation(), times)
        if attribute is not None:
            attributes[primvar.GetPrimvarName()] = attribute
    if mesh.GetNormalsAttr().HasAuthoredValue():
        normals = _values_of(mesh.GetNormalsAttr().Get, mesh.GetNormalsInterpolation(), times)
        if normals is not None:
            attributes["normals"] = Attribute(normals.values, normals.domain, semantic="normal",
                                              animated=normals.animated)
    return positions, faces, attributes, float(stage.GetTimeCodesPerSecond())


def _faces_at(mesh: Any, time: Any) -> Polygons:
    return Polygons(np.asarray(mesh.GetFaceVertexCountsAttr().Get(time), np.uint32),
                    np.asarray(mesh.GetFaceVertexIndicesAttr().Get(time), np.uint32))


def _values_of(get: Any, interpolation: str, times: List[Any]) -> Optional[Attribute]:
    """None where the values are no numbers."""
    values = [np.asarray(get(time)) for time in times]
    if values[0].dtype.kind not in "fiub":
        return None
    if interpolation == "constant":
        values = [v[None] if v.ndim == 0 else v for v in values]
    return over_time(values, _DOMAINS[interpolation], len(times))


def to_usd(sequence: Sequence, path: Path, prim: str = "/mesh", shot: int = 0) -> None:
    """Writes a shot as a mesh of a new stage (.usda, .usdc): points as time samples, attributes as primvars, animated
    ones with time samples, normals as normals."""
    from pxr import Gf, Sdf, Usd, UsdGeom, Vt

    piece = sequence.shots[shot]
    stage = Usd.Stage.CreateNew(os.fspath(path))
    mesh = UsdGeom.Mesh.Define(stage, prim)
    stage.SetDefaultPrim(stage.GetPrimAtPath("/" + prim.strip("/").split("/")[0]))
    rate = sequence.fps or 24.0
    stage.SetTimeCodesPerSecond(rate)
    stage.SetFramesPerSecond(rate)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(piece.frames) - 1)
    polygons = piece.polygons
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(polygons.sizes.astype(np.int32)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(polygons.corners.astype(np.int32)))
    mesh.CreateSubdivisionSchemeAttr("none")
    points, extent = mesh.CreatePointsAttr(), mesh.CreateExtentAttr()
    for time, frame in enumerate(piece.frames):
        xyz = sequence[frame]
        points.Set(Vt.Vec3fArray.FromNumpy(xyz), time)
        extent.Set(Vt.Vec3fArray([Gf.Vec3f(*map(float, xyz.min(axis=0))), Gf.Vec3f(*map(float, xyz.max(axis=0)))]), time)
    for info in piece.attributes.all:
        _write_attribute(sequence, mesh, info, piece.frames, Sdf, Vt)
    stage.GetRootLayer().Save()


def _write_attribute(sequence: Sequence, mesh: Any, info: AttributeInfo, frames: range, Sdf: Any, Vt: Any) -> None:
    from pxr import UsdGeom

    if info.semantic == "normal" and info.channels == 3:
        attribute, array = mesh.CreateNormalsAttr(), Vt.Vec3fArray
        mesh.SetNormalsInterpolation(_INTERPOLATIONS[info.domain])
    else:
        kind, array = _type_of(info, Sdf, Vt)
        name = "st" if info.semantic == "texture_coordinate" and info.channels == 2 else info.name
        primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(_identifier(name), kind, _INTERPOLATIONS[info.domain])
        if info.channels > 1 and kind in (Sdf.ValueTypeNames.FloatArray, Sdf.ValueTypeNames.IntArray):
            primvar.SetElementSize(info.channels)
        attribute = primvar.GetAttr()
    reader = sequence.attribute(info)
    for time, frame in enumerate(frames):
        values = reader[frame]
        if info.dtype != np.float32:
            values = values.astype(np.float32) / np.iinfo(info.dtype).max if info.normalised else values.astype(np.int32)
        flat = array in (Vt.FloatArray, Vt.IntArray)
        sample = array.FromNumpy(np.ascontiguousarray(values.ravel() if flat else values))
        if not info.animated:
            attribute.Set(sample)
            return
        attribute.Set(sample, time)


def _type_of(info: AttributeInfo, Sdf: Any, Vt: Any) -> Tuple[Any, Any]:
    names = Sdf.ValueTypeNames
    if info.dtype != np.float32 and not info.normalised:
        return names.IntArray, Vt.IntArray
    if info.semantic == "texture_coordinate" and info.channels == 2:
        return names.TexCoord2fArray, Vt.Vec2fArray
    if info.semantic == "colour" and info.channels == 3:
        return names.Color3fArray, Vt.Vec3fArray
    if info.channels == 3:
        return (names.Vector3fArray if info.semantic == "velocity" else names.Float3Array), Vt.Vec3fArray
    return names.FloatArray, Vt.FloatArray


def _identifier(name: str) -> str:
    from pxr import Tf

    return str(Tf.MakeValidIdentifier(name))
