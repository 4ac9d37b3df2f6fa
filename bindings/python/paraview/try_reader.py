"""pvpython try_reader.py FILE.reeb FIELD PICTURE.png: reads a file through the plugin, checks its steps, draws one."""

import inspect
import os
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import reeb

# Debian 12's ParaView, 5.11, wants what its Python, 3.11, has no more.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

path, field, picture = sys.argv[1:]
simple.LoadPlugin(os.path.join(os.path.dirname(os.path.abspath(__file__)), "reeb_reader.py"), ns=globals())
reader = ReebReader(FileName=path)  # noqa: F821
sequence = reeb.open(path)
reader.UpdatePipelineInformation()
times = list(reader.TimestepValues)
assert len(times) == len(sequence), times
cells = None
for frame in (0, len(times) // 2, len(times) - 1):
    reader.UpdatePipeline(times[frame])
    data = servermanager.Fetch(reader)
    assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), sequence[frame])
    assert np.array_equal(vtk_to_numpy(data.GetPointData().GetArray(field)), sequence.attribute(field)[frame])
    changed = reader.GetClientSideObject().GetOutputDataObject(0).GetPolys().GetMTime()
    assert cells in (None, changed), "the cells were made anew"
    cells = changed
view = simple.CreateView("RenderView")
view.ViewSize = [800, 500]
view.ViewTime = times[len(times) // 2]
display = simple.Show(reader, view)
simple.ColorBy(display, ("POINTS", field))
display.RescaleTransferFunctionToDataRange(False, True)
simple.ResetCamera(view)
view.GetActiveCamera().Elevation(-50)
view.GetActiveCamera().Azimuth(20)
simple.Render(view)
simple.SaveScreenshot(picture, view)
print(f"{len(times)} steps; {picture}")
