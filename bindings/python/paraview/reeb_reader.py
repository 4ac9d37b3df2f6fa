"""ParaView reader of `.reeb` files: Tools, Manage Plugins, Load New, this file; or LoadPlugin in a script.

The package reeb must be one that ParaView's Python imports, e.g. by PYTHONPATH. Time steps are those of the file; the
cells stay the same object from step to step of a shot; attributes of vertices and faces are point and cell data.
Debian 12's ParaView, 5.11, loads no plugin in Python before `inspect.getargspec` is put back: try_reader.py does that.
"""

import numpy as np
from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

import reeb


@smproxy.reader(name="ReebReader", label="Reeb Reader", extensions="reeb", file_description="Reeb animated meshes")
class ReebReader(VTKPythonAlgorithmBase):

    def __init__(self):
        VTKPythonAlgorithmBase.__init__(self, nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._name, self._sequence, self._cells = None, None, {}

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="reeb", file_description="Reeb animated meshes")
    def SetFileName(self, name):
        if name != self._name:
            self._name, self._sequence, self._cells = name, None, {}
            self.Modified()

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        return self._times().tolist() if self._name else None

    def _open(self):
        if self._sequence is None:
            self._sequence = reeb.open(self._name)
        return self._sequence

    def _times(self):
        """Seconds, or frames where the rate is unknown."""
        sequence = self._open()
        return np.arange(float(len(sequence))) if sequence.times is None else sequence.times

    def RequestInformation(self, request, inputs, outputs):
        times = self._times()
        information = outputs.GetInformationObject(0)
        information.Set(Pipeline.TIME_STEPS(), times.tolist(), len(times))
        information.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        sequence, times = self._open(), self._times()
        information = outputs.GetInformationObject(0)
        time = information.Get(Pipeline.UPDATE_TIME_STEP()) if information.Has(Pipeline.UPDATE_TIME_STEP()) else times[0]
        frame = max(int(np.searchsorted(times, time * (1 + 1e-9) + 1e-9, side="right")) - 1, 0)
        shot = sequence.shots[sequence.shot_of(frame)]
        output = vtkPolyData.GetData(outputs, 0)
        points = vtkPoints()
        points.SetData(numpy_to_vtk(sequence[frame], deep=True))
        output.SetPoints(points)
        output.SetPolys(self._cells_of(shot))
        for info in shot.attributes.all:
            if info.domain in ("vertex", "face"):
                array = numpy_to_vtk(sequence.attribute(info)[frame], deep=True)
                array.SetName(info.name)
                (output.GetPointData() if info.domain == "vertex" else output.GetCellData()).AddArray(array)
        return 1

    def _cells_of(self, shot):
        if shot.index not in self._cells:
            polygons = shot.polygons
            ends = np.concatenate(([0], np.cumsum(polygons.sizes))).astype(np.int64)
            cells = vtkCellArray()
            cells.SetData(numpy_to_vtkIdTypeArray(ends, deep=True),
                          numpy_to_vtkIdTypeArray(polygons.corners.astype(np.int64), deep=True))
            self._cells[shot.index] = cells
        return self._cells[shot.index]
