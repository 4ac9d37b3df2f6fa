"""Reeb: a codec for animated triangle meshes.

    import reeb

    seq = reeb.open("walk.reeb")
    seq[10]             # float32 [vertices, 3]: frame 10
    seq[10:20]          # float32 [10, vertices, 3]
    seq.faces           # uint32 [triangles, 3]

Positions are in the units of the file that was encoded, times in seconds, frames, shots and groups counted from 0.
"""

from ._attributes import AttributeInfo, AttributeReader, Attributes, Polygons, Resource
from ._core import (CancelledError, CorruptError, LimitError, ReebError, TruncatedError, UnsupportedError,
                    format_version)
from ._core import version as __version__
from ._open import open
from ._render_mesh import MaterialRange, RenderMesh
from ._sequence import Sequence, Shot

__all__ = [
    "AttributeInfo", "AttributeReader", "Attributes", "CancelledError", "CorruptError", "LimitError", "MaterialRange", "Polygons",
    "ReebError", "RenderMesh", "Resource", "Sequence", "Shot", "TruncatedError", "UnsupportedError", "__version__",
    "format_version", "open"
]
