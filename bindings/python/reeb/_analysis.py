"""What meshes are made of, how far sequences are from each other, which shapes are alike."""

import os
from dataclasses import dataclass
from typing import Any, List, Mapping, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import Signature
from ._input import faces_of, positions_of
from ._sequence import Sequence
from ._types import FloatArray, IndexArray, Path

NODE_TYPES = ("minimum", "maximum", "saddle")
PARTS = ("all", "charts", "spectrum", "body")


@dataclass(frozen=True)
class ReebGraph:
    """Critical points of the scalar function, and the families of contours between them."""

    vertices: IndexArray  #: uint32 [nodes]: where each is
    values: "NDArray[np.float64]"  #: float64 [nodes]: of the function, 0 to 1
    types: List[str]  #: "minimum", "maximum" or "saddle"
    arcs: IndexArray  #: uint32 [arcs, 2]: nodes
    arc_regions: IndexArray  #: uint32 [arcs]: label of the vertices of each
    loops: int  #: independent cycles: the genus of a closed surface


@dataclass(frozen=True)
class Segmentation:
    """Regions of a mesh by the Reeb graph of heat diffusion."""

    labels: IndexArray  #: uint32 [vertices]: the region of each, from 0
    scalar: "NDArray[np.float64]"  #: float64 [vertices]: the function, 0 to 1
    feature_points: IndexArray  #: uint32 [extremities]: their vertices
    graph: ReebGraph
    warnings: List[str]

    @property
    def region_count(self) -> int:
        return int(self.labels.max()) + 1 if len(self.labels) else 0


def segment(positions: ArrayLike, faces: Any, regions: int = 0) -> Segmentation:
    """Regions of a mesh, and its Reeb graph.

    positions: [vertices, 3]; or [frames, vertices, 3], of which the first frame is segmented.
    faces: as of `encode`.
    regions: 0 = the arcs of the graph; else at most so many, which follow the motion of the frames.
    """
    given = np.asarray(positions)
    frames, _ = positions_of(given[None] if given.ndim == 2 else given)
    if regions < 0:
        raise ValueError(f"regions: is 0 or more, not {regions}")
    raw = _core.segment(frames, *faces_of(faces, frames.shape[1]), regions)
    graph = raw["graph"]
    return Segmentation(
        raw["labels"], raw["scalar"], raw["feature_points"],
        ReebGraph(graph["vertices"], graph["values"], [NODE_TYPES[t] for t in graph["types"]], graph["arcs"][:, :2],
                  graph["arcs"][:, 2], graph["loops"]), raw["warnings"])


@dataclass(frozen=True)
class Comparison:
    """How far a sequence is from an original. Errors are in units of the original, frames and vertices from 0."""

    kg: float  #: KG error in percent: 100 |A - B| / |A - mean of each frame of A|
    rmse: float  #: root of the mean squared displacement of a vertex
    max_error: float  #: largest error of a coordinate
    max_frame: int
    max_vertex: int
    sted: Optional[float]  #: spatio-temporal edge difference (Vasa and Skala, 2011); None without faces
    diagonal: float  #: of the box around all positions of the original
    identical: bool  #: to the bit
    frames: "NDArray[np.float64]"  #: float64 [frames, 3]: KG, RMSE and largest error of each


def compare(original: Union[ArrayLike, Sequence], other: Union[ArrayLike, Sequence], faces: Any = None) -> Comparison:
    """Compares two sequences vertex by vertex: arrays [frames, vertices, 3] or open sequences of one shot. `faces`, as
    of `encode`, are those of a sequence if there is one; the STED error needs them."""
    a, b = (positions_of(s[:] if isinstance(s, Sequence) else s)[0] for s in (original, other))
    if a.shape != b.shape:
        raise ValueError(f"other: is {list(b.shape)}, and the original is {list(a.shape)}")
    if faces is None:
        faces = next((s.polygons for s in (original, other) if isinstance(s, Sequence)), [])
    return Comparison(**_core.compare(a, b, *faces_of(faces, a.shape[1])))


def sign(positions: ArrayLike, faces: Any) -> Signature:
    """What a shape, [vertices, 3], is recognised by, whatever its pose, size and place. ValueError of a mesh without a
    surface."""
    mesh, _ = positions_of(np.asarray(positions), ndim=2)
    return _core.sign(mesh[None], *faces_of(faces, len(mesh)))


@dataclass(frozen=True)
class Match:
    """A shape that was found."""

    name: str
    frame: int  #: of a sequence in an archive, from 0
    score: float  #: 0 to 100
    distance: float


def search(query: Union[Signature, Tuple[ArrayLike, Any]], shapes: Union[Path, Mapping[str, Signature]], *,
           count: int = 10, by: str = "all") -> List[Match]:
    """The shapes that are most like one, best first.

    query: (positions, faces), or a signature, as `sign` gives it.
    shapes: an archive made by `reeb index`, or signatures by name.
    by: what is compared: "all", "charts", "spectrum" or "body".
    """
    if by not in PARTS:
        raise ValueError(f"by: is one of {', '.join(PARTS)}, not {by!r}")
    signature = query if isinstance(query, Signature) else sign(*query)
    if isinstance(shapes, (str, os.PathLike)):
        listed = _core.read_archive(os.fspath(shapes))
    else:
        listed = [(name, 0, shape) for name, shape in shapes.items()]
    best: "dict[str, Match]" = {}
    for name, frame, shape in listed:
        distance = signature.distance(shape)[by]
        if name not in best or distance < best[name].distance:
            best[name] = Match(name, frame, 100 / (1 + distance), distance)
    return sorted(best.values(), key=lambda match: match.distance)[:count]
