"""Meshes of VTK: pip install 'reeb[vtk]'."""

import os
import xml.etree.ElementTree as xml
from typing import Any, Dict, List, Optional, Sequence as Items, Tuple, Union

import numpy as np

from ._attributes import AttributeInfo, Polygons
from ._input import AttributeLike
from ._neighbours import over_time
from ._sequence import Sequence
from ._types import AnyArray, FloatArray, Path


def from_vtk(source: Union[Path, Items[Path]]) -> Tuple[FloatArray, Polygons, Dict[str, AttributeLike],
                                                        Optional[float]]:
    """Positions [frames, vertices, 3], faces, attributes and frames per second (None where unknown) for `encode`.

    source: a `.pvd` collection, or `.vtp` or `.vtu` files, one for each frame. Cells of two dimensions are faces.
    Point and cell data of numbers come along, animated where they change. ValueError where the faces change, or there
    are cells of another dimension.
    """
    files, times = _files_of(source)
    frames = [_read(path) for path in files]
    faces = frames[0][1]
    for path, (xyz, other, _, _) in zip(files, frames):
        if xyz.shape != frames[0][0].shape or not (np.array_equal(other.sizes, faces.sizes)
                                                   and np.array_equal(other.corners, faces.corners)):
            raise ValueError(f"{path}: other faces or vertices than {files[0]}")
    attributes: Dict[str, AttributeLike] = {}
    for domain, fields in (("vertex", [frame[2] for frame in frames]), ("face", [frame[3] for frame in frames])):
        for name in fields[0]:
            values = [field[name] for field in fields if name in field]
            attributes[name] = over_time(values, domain, len(frames))
    steps = np.diff(times) if times is not None and len(times) > 1 else np.empty(0)
    rate = 1 / float(steps.mean()) if len(steps) and steps.min() > 0 and np.allclose(steps, steps[0]) else None
    return np.stack([frame[0] for frame in frames]), faces, attributes, rate


def _files_of(source: Union[Path, Items[Path]]) -> Tuple[List[str], Optional[List[float]]]:
    if not isinstance(source, (str, os.PathLike)):
        files = [os.fspath(path) for path in source]
        if not files:
            raise ValueError("source: there is no file")
        return files, None
    path = os.fspath(source)
    if not path.endswith(".pvd"):
        return [path], None
    sets = xml.parse(path).getroot().findall("./Collection/DataSet")
    if not sets:
        raise ValueError(f"{path}: lists no data set")
    sets.sort(key=lambda item: float(item.get("timestep", "0")))
    folder = os.path.dirname(path)
    return ([os.path.join(folder, item.get("file", "")) for item in sets],
            [float(item.get("timestep", "0")) for item in sets])


def _read(path: str) -> Tuple[FloatArray, Polygons, Dict[str, AnyArray], Dict[str, AnyArray]]:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    if not os.path.exists(path):
        raise FileNotFoundError(path)
    flat = path.endswith(".vtp")
    reader = vtkXMLPolyDataReader() if flat else vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    if data.GetNumberOfPoints() == 0:
        raise ValueError(f"{path}: has no points")
    cells = data.GetPolys() if flat else data.GetCells()
    wrong = any(data.GetCell(i).GetCellDimension() != 2 for i in range(data.GetNumberOfCells())) if not flat else (
        data.GetNumberOfCells() != cells.GetNumberOfCells())
    if wrong:
        raise ValueError(f"{path}: has cells that are no polygons")
    ends = vtk_to_numpy(cells.GetOffsetsArray())
    faces = Polygons(np.diff(ends).astype(np.uint32), vtk_to_numpy(cells.GetConnectivityArray()).astype(np.uint32))
    xyz = np.array(vtk_to_numpy(data.GetPoints().GetData()), np.float32)
    return xyz, faces, _arrays(data.GetPointData()), _arrays(data.GetCellData())


def _arrays(data: Any) -> Dict[str, AnyArray]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    arrays = (data.GetArray(i) for i in range(data.GetNumberOfArrays()))
    return {a.GetName(): np.array(vtk_to_numpy(a)) for a in arrays if a is not None and a.GetName()}


def polydata(sequence: Sequence, frame: int) -> Any:
    """A frame as vtkPolyData, with its fields of vertices and faces as point and cell data."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    shot = sequence.shots[sequence.shot_of(frame)]
    points, cells, out = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(sequence[frame], deep=True))
    ends = np.concatenate(([0], np.cumsum(shot.polygons.sizes))).astype(np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(ends, deep=True),
                  numpy_to_vtkIdTypeArray(shot.polygons.corners.astype(np.int64), deep=True))
    out.SetPoints(points)
    out.SetPolys(cells)
    for info in shot.attributes.all:
        if info.domain in ("vertex", "face"):
            array = numpy_to_vtk(sequence.attribute(info)[frame], deep=True)
            array.SetName(info.name)
            (out.GetPointData() if info.domain == "vertex" else out.GetCellData()).AddArray(array)
    return out


def to_vtkhdf(sequence: Sequence, path: Path, shot: int = 0) -> None:
    """Writes a shot as a VTKHDF file of temporal poly data, for VTK 9.4 and ParaView 5.13 or later: the cells and
    static fields once, points and animated fields for each frame."""
    import h5py

    piece = sequence.shots[shot]
    count = len(piece.frames)
    with h5py.File(os.fspath(path), "w") as file:
        root = file.create_group("VTKHDF", track_order=True)
        root.attrs["Version"] = (2, 2)
        kind = b"PolyData"
        root.attrs.create("Type", kind, dtype=h5py.string_dtype("ascii", len(kind)))
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = count
        steps["Values"] = [i / sequence.fps if sequence.fps else float(i) for i in range(count)]
        steps["PartOffsets"] = np.zeros(count, np.int64)
        steps["NumberOfParts"] = np.ones(count, np.int64)
        steps["PointOffsets"] = np.arange(count) * piece.vertex_count
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            steps[name] = np.zeros((count, 4), np.int64)
        root["NumberOfPoints"] = np.array([piece.vertex_count])
        _write_cells(root, piece.polygons)
        points = root.create_dataset("Points", (count * piece.vertex_count, 3), np.float32)
        for i, frame in enumerate(piece.frames):
            points[i * piece.vertex_count:(i + 1) * piece.vertex_count] = sequence[frame]
        for info in piece.attributes.all:
            if info.domain in ("vertex", "face"):
                _write_field(root, steps, sequence, info, piece.frames)


def _write_cells(root: Any, polygons: Polygons) -> None:
    none = np.empty(0, np.uint32)
    for kind, cells in (("Vertices", None), ("Lines", None), ("Polygons", polygons), ("Strips", None)):
        sizes, corners = (none, none) if cells is None else (cells.sizes, cells.corners)
        group = root.create_group(kind)
        group["NumberOfCells"] = np.array([len(sizes)])
        group["NumberOfConnectivityIds"] = np.array([len(corners)])
        group["Offsets"] = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
        group["Connectivity"] = corners.astype(np.int64)


def _write_field(root: Any, steps: Any, sequence: Sequence, info: AttributeInfo, frames: range) -> None:
    kind = "PointData" if info.domain == "vertex" else "CellData"
    reader = sequence.attribute(info)
    first = reader[frames[0]]
    shown = frames if info.animated else frames[:1]
    data = root.require_group(kind).create_dataset(info.name, (len(shown) * len(first), *first.shape[1:]), info.dtype)
    for i, frame in enumerate(shown):
        data[i * len(first):(i + 1) * len(first)] = reader[frame]
    offsets = np.arange(len(frames)) * (len(first) if info.animated else 0)
    steps.require_group(f"{kind}Offsets")[info.name] = offsets
