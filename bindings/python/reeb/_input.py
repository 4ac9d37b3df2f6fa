"""Arrays of the caller as the encoder takes them, or a ValueError that says which is wrong, and where."""

from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Sequence as Items, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from ._attributes import DOMAINS, SEMANTICS, Polygons
from ._types import AnyArray, FloatArray, IndexArray

_MAX_CHANNELS = 16
_TYPES = {np.dtype(np.float32): 0, np.dtype(np.uint8): 1, np.dtype(np.uint16): 2, np.dtype(np.int32): 3}
_NORMALISED_TYPES = {np.dtype(np.uint8): 4, np.dtype(np.uint16): 5}


@dataclass(frozen=True)
class Attribute:
    """What `reeb.encode` takes of an attribute; `(domain, values)` or `(domain, values, keep)` is short for it.

    values: [elements] or [elements, channels]; with one more dimension in front, the frames, where it is animated.
        float32, uint8, uint16 and int32 are kept as they are, other types where one of these holds every value;
        float64 is rounded to float32.
    domain: "vertex", "corner" (of the faces, one after another), "face" or "shot".
    keep: how precisely, as of `reeb encode --attribute`: "exact"; "bits:N", steps of the range / 2^N; "error:E", the
        largest error, in units of the values; "compute:D", normals computed from positions where they are not further
        off than D degrees. None: exact for whole numbers and lossless encodings, else what suits the semantic, bits:16
        for generic ones.
    semantic: "generic", "texture_coordinate", "normal", "tangent", "colour", "velocity", "material", "group", "index".
    animated: None = told by the shape of `values`.
    normalised: uint8 and uint16 stand for parts of 255 and 65535.
    names: what the values of a material or group stand for.
    """

    values: Any
    domain: str = "vertex"
    keep: Optional[str] = None
    semantic: str = "generic"
    animated: Optional[bool] = None
    normalised: bool = False
    names: Items[str] = ()


AttributeLike = Union[Attribute, Tuple[str, ArrayLike], Tuple[str, ArrayLike, str]]


def first_place(bad: AnyArray, names: Items[str]) -> str:
    """ "frame 3, vertex 7": where the first True is."""
    place = np.unravel_index(int(np.argmax(bad)), bad.shape)
    return ", ".join(f"{name} {index}" for name, index in zip(names, place))


def to_float32(values: Any, what: str, names: Items[str]) -> Tuple[FloatArray, float]:
    """Contiguous, finite, and the largest error of rounding."""
    given = np.asarray(values)
    if given.dtype.kind not in "fiu":
        raise ValueError(f"{what}: has to be numbers, not {given.dtype}")
    with np.errstate(over="ignore"):
        out = np.ascontiguousarray(given, np.float32)
    bad = ~np.isfinite(out)
    if bad.any():
        value = given[np.unravel_index(int(np.argmax(bad)), bad.shape)]
        kind = "beyond float32" if np.isfinite(value) else "not finite"
        raise ValueError(f"{what}: {first_place(bad, names)} is {kind} ({value})")
    if given.dtype.itemsize <= 2 or given.dtype == np.float32 or given.size == 0:
        return out, 0.0
    return out, max(float(np.abs(a - b).max(initial=0)) for a, b in zip(given, out))


def positions_of(values: Any, ndim: int = 3) -> Tuple[FloatArray, float]:
    """[frames, vertices, 3], or a frame of it."""
    names = ("frame", "vertex", "axis")[3 - ndim:]
    given = np.asarray(values)
    if given.ndim != ndim or given.shape[-1] != 3:
        wanted = "[frames, vertices, 3]" if ndim == 3 else "[vertices, 3]"
        raise ValueError(f"positions: has to be {wanted}, not {list(given.shape)}")
    if 0 in given.shape:
        raise ValueError(f"positions: is empty, {list(given.shape)}")
    return to_float32(given, "positions", names)


def faces_of(faces: Any, vertex_count: int) -> Tuple[IndexArray, IndexArray]:
    """Corners of each face, and their vertices: from triangles [T, 3], any [F, K], a ragged list or Polygons."""
    if isinstance(faces, Polygons):
        sizes, corners = faces.sizes, faces.corners
    else:
        sizes, corners = _split(faces)
    if corners.dtype.kind not in "iu" and corners.size:
        raise ValueError(f"faces: has to be vertex numbers, not {corners.dtype}")
    bad = (corners < 0) | (corners >= vertex_count)
    if bad.any():
        corner = int(np.argmax(bad))
        face = int(np.searchsorted(np.cumsum(sizes), corner, side="right"))
        raise ValueError(f"faces: face {face} has vertex {corners[corner]}, and there are {vertex_count}")
    return np.ascontiguousarray(sizes, np.uint32), np.ascontiguousarray(corners, np.uint32)


def _split(faces: Any) -> Tuple[AnyArray, AnyArray]:
    if not isinstance(faces, np.ndarray):
        faces = list(faces)
        lengths = [len(face) for face in faces]
        if 0 in lengths:
            raise ValueError(f"faces: face {lengths.index(0)} has no corner")
        if len(set(lengths)) > 1:
            return np.array(lengths), np.concatenate([np.asarray(face) for face in faces])
    given = np.asarray(faces)
    if given.size == 0:
        return np.empty(0, np.uint32), np.empty(0, np.uint32)
    if given.ndim != 2:
        raise ValueError(f"faces: has to be [triangles, 3] or a list of faces, not {list(given.shape)}")
    return np.full(len(given), given.shape[1]), given.reshape(-1)


def attributes_of(attributes: Mapping[str, AttributeLike], counts: Mapping[str, int],
                  frames: int) -> List[Dict[str, Any]]:
    """`counts`: elements of each domain."""
    return [_attribute_of(name, a if isinstance(a, Attribute) else _from_tuple(name, a), counts, frames)
            for name, a in attributes.items()]


def _from_tuple(name: str, given: Any) -> Attribute:
    if not isinstance(given, tuple) or len(given) not in (2, 3) or not isinstance(given[0], str):
        raise ValueError(f"attributes[{name!r}]: has to be (domain, values), (domain, values, keep) or reeb.Attribute")
    return Attribute(given[1], given[0], *given[2:])


def _attribute_of(name: str, a: Attribute, counts: Mapping[str, int], frames: int) -> Dict[str, Any]:
    what = f"attributes[{name!r}]"
    if a.domain not in DOMAINS:
        raise ValueError(f"{what}: domain is one of {', '.join(DOMAINS)}, not {a.domain!r}")
    if a.semantic not in SEMANTICS:
        raise ValueError(f"{what}: semantic is one of {', '.join(SEMANTICS)}, not {a.semantic!r}")
    values = _to_kept_type(np.asarray(a.values), what)
    animated, channels = _layout(values.shape, a, counts[a.domain], frames, what)
    types = _NORMALISED_TYPES if a.normalised else _TYPES
    if values.dtype not in types:
        raise ValueError(f"{what}: normalised values are uint8 or uint16, not {values.dtype}")
    return {"name": name, "semantic": SEMANTICS.index(a.semantic), "domain": DOMAINS.index(a.domain),
            "type": types[values.dtype], "channels": channels, "animated": animated, "names": list(a.names),
            "keep": a.keep or "", "values": values.tobytes()}


def _to_kept_type(given: AnyArray, what: str) -> AnyArray:
    if given.dtype in _TYPES:
        return given
    if given.dtype.kind == "f":
        with np.errstate(over="ignore"):
            rounded: AnyArray = given.astype(np.float32)
        if (np.isinf(rounded) & np.isfinite(given)).any():
            raise ValueError(f"{what}: has values beyond float32")
        return rounded
    if given.dtype.kind == "b":
        return given.astype(np.uint8)
    if given.dtype.kind in "iu":
        limits = np.iinfo(np.int32)
        if given.size and (given.min() < limits.min or given.max() > limits.max):
            raise ValueError(f"{what}: has values beyond int32")
        return given.astype(np.int32)
    raise ValueError(f"{what}: has to be numbers, not {given.dtype}")


def _layout(shape: Tuple[int, ...], a: Attribute, elements: int, frames: int, what: str) -> Tuple[bool, int]:
    """Whether it is animated, and channels."""
    def fits(layout: Tuple[int, ...]) -> bool:
        rest = shape[len(layout):]
        return shape[:len(layout)] == layout and (rest == () or (len(rest) == 1 and 1 <= rest[0] <= _MAX_CHANNELS))

    still, moving = (elements,), (frames, elements)
    found = [animated for animated, layout in ((False, still), (True, moving))
             if a.animated in (None, animated) and fits(layout)]
    if not found:
        raise ValueError(f"{what}: is {list(shape)}; there are {elements} values of a {a.domain}, so it has to be "
                         f"[{elements}], or [{frames}, {elements}] if it is animated, with up to {_MAX_CHANNELS} "
                         "channels as a last dimension")
    if len(found) > 1:
        raise ValueError(f"{what}: {list(shape)} may be animated or not; say reeb.Attribute(..., animated=True)")
    rest = shape[len(moving if found[0] else still):]
    return found[0], rest[0] if rest else 1
