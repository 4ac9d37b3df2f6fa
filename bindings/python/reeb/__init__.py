"""Reeb: a codec for animated triangle meshes.

    import reeb

    seq = reeb.open("walk.reeb")
    seq[10]             # float32 [vertices, 3]: frame 10
    seq[10:20]          # float32 [10, vertices, 3]
    seq.faces           # uint32 [triangles, 3]

Positions are in the units of the file that was encoded, times in seconds, frames, shots and groups counted from 0.
"""

from ._analysis import Comparison, Match, ReebGraph, Segmentation, compare, search, segment, sign
from ._attributes import AttributeInfo, AttributeReader, Attributes, Polygons, Resource
from ._core import (CancelledError, CorruptError, LimitError, ReebError, Signature, TruncatedError, UnsupportedError,
                    format_version)
from ._core import version as __version__
from ._encode import Encoded, encode
from ._encoder import Encoder
from ._input import Attribute
from ._neighbours import from_trimesh, to_open3d, to_pyvista, to_trimesh
from ._open import open
from ._render_mesh import MaterialRange, RenderMesh
from ._report import Report, report
from ._sequence import Sequence, Shot
from ._usd import from_usd, to_usd
from ._vtk import from_vtk, polydata, to_vtkhdf

__all__ = [
    "Attribute", "AttributeInfo", "AttributeReader", "Attributes", "CancelledError", "Comparison", "CorruptError",
    "Encoded", "Encoder", "LimitError", "Match", "MaterialRange", "Polygons", "ReebError", "ReebGraph", "RenderMesh",
    "Report", "Resource", "Segmentation", "Sequence", "Shot", "Signature", "TruncatedError", "UnsupportedError",
    "__version__", "compare", "encode", "format_version", "from_trimesh", "from_usd", "from_vtk", "open", "polydata",
    "report", "search", "segment", "sign", "to_open3d", "to_pyvista", "to_trimesh", "to_usd", "to_vtkhdf"
]
