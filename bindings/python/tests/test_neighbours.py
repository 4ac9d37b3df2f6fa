import numpy as np
import pytest
from test_writing import FACES, SINGLE

import reeb

PRESSURE = np.sin(2 * SINGLE[..., 2] + 3 * np.arange(len(SINGLE), dtype=np.float32)[:, None])
ERROR = 0.002


@pytest.fixture(scope="module")
def sequence():
    part = (np.arange(len(FACES)) % 3).astype(np.int32)
    data = reeb.encode(SINGLE, FACES, kg=0.02, fps=10,
                       attributes={"pressure": ("vertex", PRESSURE, f"error:{ERROR}"), "part": ("face", part)})
    return reeb.open(data)


def test_trimesh(sequence):
    trimesh = pytest.importorskip("trimesh")
    mesh = reeb.to_trimesh(sequence, 3)
    assert isinstance(mesh, trimesh.Trimesh)
    np.testing.assert_array_equal(mesh.vertices, sequence[3])
    np.testing.assert_array_equal(mesh.faces, sequence.faces)
    np.testing.assert_array_equal(mesh.vertex_attributes["pressure"], sequence.attribute("pressure")[3])
    np.testing.assert_array_equal(mesh.face_attributes["part"], sequence.attribute("part")[3])
    meshes = [reeb.to_trimesh(sequence, i) for i in range(len(sequence))]
    positions, faces, attributes = reeb.from_trimesh(meshes)
    again = reeb.open(reeb.encode(positions, faces, lossless=True, attributes=attributes))
    np.testing.assert_array_equal(again[:], sequence[:])
    np.testing.assert_array_equal(again.faces, sequence.faces)
    np.testing.assert_array_equal(again.attribute("pressure")[:], sequence.attribute("pressure")[:])
    assert not again.attributes["part"].animated
    meshes[2].faces = meshes[2].faces[::-1]
    with pytest.raises(ValueError, match="frame 2 has other faces"):
        reeb.from_trimesh(meshes)


def test_pyvista(sequence):
    pyvista = pytest.importorskip("pyvista")
    view = reeb.to_pyvista(sequence)
    mesh, points, cells = view.mesh, view.mesh.points, view.mesh.faces.ctypes.data
    assert isinstance(mesh, pyvista.PolyData) and mesh.n_cells == len(FACES)
    view.set_time(0.5)
    assert view.mesh is mesh and mesh.points is not None and mesh.faces.ctypes.data == cells
    np.testing.assert_array_equal(mesh.points, sequence[5])
    np.testing.assert_array_equal(points, sequence[5])  # in place
    np.testing.assert_array_equal(mesh.point_data["pressure"], sequence.attribute("pressure")[5])
    assert np.abs(mesh.point_data["pressure"] - PRESSURE[5]).max() <= ERROR
    np.testing.assert_array_equal(mesh.cell_data["part"], sequence.attribute("part")[5])
    np.testing.assert_array_equal(mesh.regular_faces, sequence.faces)
    view.set_frame(2.5)
    np.testing.assert_array_equal(mesh.points, sequence.between(2.5))
    with pytest.raises(IndexError):
        view.set_frame(99)


def test_usd(sequence, tmp_path):
    Usd = pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom
    path = tmp_path / "tube.usdc"
    reeb.to_usd(sequence, path, "/World/Tube")
    stage = Usd.Stage.Open(str(path))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/Tube"))
    assert stage.GetTimeCodesPerSecond() == 10 and mesh.GetPointsAttr().GetNumTimeSamples() == len(sequence)
    np.testing.assert_array_equal(np.asarray(mesh.GetPointsAttr().Get(4)), sequence[4])
    pressure = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("pressure")
    assert pressure.GetInterpolation() == "vertex"
    assert np.abs(np.asarray(pressure.Get(7)) - PRESSURE[7]).max() <= ERROR
    positions, faces, attributes, fps = reeb.from_usd(path, "/World/Tube")
    again = reeb.open(reeb.encode(positions, faces, lossless=True, fps=fps, attributes=attributes))
    np.testing.assert_array_equal(again[:], sequence[:])
    np.testing.assert_array_equal(again.faces, sequence.faces)
    np.testing.assert_array_equal(again.attribute("pressure")[:], sequence.attribute("pressure")[:])
    np.testing.assert_array_equal(again.attribute("part")[0], sequence.attribute("part")[0])
    assert again.fps == 10
    with pytest.raises(ValueError, match="is no mesh"):
        reeb.from_usd(path, "/World")


def write_series(sequence, folder):
    """A `.pvd` of `.vtp` and `.vtu` files, by VTK itself."""
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter
    sets = []
    for i in range(len(sequence)):
        data, writer, kind = reeb.polydata(sequence, i), vtkXMLPolyDataWriter(), "vtp"
        if i % 2:
            append = vtkAppendFilter()
            append.AddInputData(data)
            append.Update()
            data, writer, kind = append.GetOutput(), vtkXMLUnstructuredGridWriter(), "vtu"
        writer.SetInputData(data)
        writer.SetFileName(str(folder / f"f{i}.{kind}"))
        writer.Write()
        sets.append(f'<DataSet timestep="{i / 10}" file="f{i}.{kind}"/>')
    path = folder / "series.pvd"
    path.write_text(f'<VTKFile type="Collection"><Collection>{"".join(sets)}</Collection></VTKFile>')
    return path


def test_vtk_series(sequence, tmp_path):
    pytest.importorskip("vtkmodules")
    positions, faces, attributes, fps = reeb.from_vtk(write_series(sequence, tmp_path))
    assert fps == pytest.approx(10)
    again = reeb.open(reeb.encode(positions, faces, lossless=True, attributes=attributes))
    np.testing.assert_array_equal(again[:], sequence[:])
    np.testing.assert_array_equal(again.faces, sequence.faces)
    np.testing.assert_array_equal(again.attribute("pressure")[:], sequence.attribute("pressure")[:])
    assert again.attributes["pressure"].animated and again.attributes["part"].domain == "face"
    with pytest.raises(FileNotFoundError):
        reeb.from_vtk([tmp_path / "none.vtp"])


def test_vtkhdf(sequence, tmp_path):
    pytest.importorskip("vtkmodules")
    h5py = pytest.importorskip("h5py")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkIOHDF import vtkHDFReader
    if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) < (9, 4):
        pytest.skip("VTK before 9.4")
    path = tmp_path / "tube.vtkhdf"
    reeb.to_vtkhdf(sequence, path)
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(sequence)
    for step in (0, 4, 11):
        reader.SetStep(step)
        reader.Update()
        data = reader.GetOutput()
        np.testing.assert_array_equal(vtk_to_numpy(data.GetPoints().GetData()), sequence[step])
        pressure = vtk_to_numpy(data.GetPointData().GetArray("pressure"))
        assert np.abs(pressure - PRESSURE[step]).max() <= ERROR
        np.testing.assert_array_equal(vtk_to_numpy(data.GetCellData().GetArray("part")), sequence.attribute("part")[0])
        connectivity = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
        np.testing.assert_array_equal(connectivity.reshape(-1, 3), sequence.faces)
    with h5py.File(path) as file:
        assert len(file["VTKHDF/Polygons/Connectivity"]) == FACES.size  # once, not for each frame


def test_open3d(sequence):
    pytest.importorskip("open3d")
    mesh = reeb.to_open3d(sequence, 2)
    np.testing.assert_array_equal(np.asarray(mesh.vertices), sequence[2])
    np.testing.assert_array_equal(np.asarray(mesh.triangles), sequence.faces)
