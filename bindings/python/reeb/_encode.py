"""reeb.encode."""

import os
import tempfile
from typing import Any, Callable, Dict, Mapping, Optional, Tuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._input import AttributeLike, attributes_of, faces_of, positions_of
from ._report import Report, report_of
from ._types import FloatArray, Path

Progress = Callable[[float], object]
PROFILES = ("main", "fast", "thesis")
DEFAULT_KG = 0.05


class Encoded(bytes):
    """The bytes of a file, and the figures of its encoding."""

    report: Report


@overload
def encode(positions: ArrayLike, faces: Any, path: None = None, *, kg: Optional[float] = ...,
           max_error: Union[float, str, None] = ..., bpvf: Optional[float] = ..., size: Optional[int] = ...,
           lossless: bool = ..., profile: str = ..., effort: int = ..., fps: Optional[float] = ...,
           start_time: float = ..., attributes: Mapping[str, AttributeLike] = ...,
           resources: Mapping[str, Tuple[str, bytes]] = ..., metadata: Mapping[str, str] = ...,
           group_length: int = ..., open_groups: int = ..., reorder: bool = ..., regions: int = ...,
           threads: int = ..., note_errors: bool = ..., progress: Optional[Progress] = ...) -> Encoded: ...


@overload
def encode(positions: ArrayLike, faces: Any, path: Path, *, kg: Optional[float] = ...,
           max_error: Union[float, str, None] = ..., bpvf: Optional[float] = ..., size: Optional[int] = ...,
           lossless: bool = ..., profile: str = ..., effort: int = ..., fps: Optional[float] = ...,
           start_time: float = ..., attributes: Mapping[str, AttributeLike] = ...,
           resources: Mapping[str, Tuple[str, bytes]] = ..., metadata: Mapping[str, str] = ...,
           group_length: int = ..., open_groups: int = ..., reorder: bool = ..., regions: int = ...,
           threads: int = ..., note_errors: bool = ..., progress: Optional[Progress] = ...) -> Report: ...


def encode(positions: ArrayLike,
           faces: Any,
           path: Optional[Path] = None,
           *,
           kg: Optional[float] = None,
           max_error: Union[float, str, None] = None,
           bpvf: Optional[float] = None,
           size: Optional[int] = None,
           lossless: bool = False,
           profile: str = "main",
           effort: int = 5,
           fps: Optional[float] = None,
           start_time: float = 0.0,
           attributes: Mapping[str, AttributeLike] = {},
           resources: Mapping[str, Tuple[str, bytes]] = {},
           metadata: Mapping[str, str] = {},
           group_length: int = 0,
           open_groups: int = -1,
           reorder: bool = False,
           regions: int = -1,
           threads: int = 0,
           note_errors: bool = True,
           progress: Optional[Progress] = None) -> Union[Encoded, Report]:
    """Compresses frames of one connectivity.

    positions: [frames, vertices, 3], any array-like; kept in float32, and where that rounds the report says by how
        much.
    faces: [triangles, 3], or faces of any number of corners: an array [faces, corners], a list of lists, Polygons.
    path: of the file to write, under another name until it is whole. None: the bytes are given back, as `Encoded`,
        which has a `report`; else the Report is.

    One target, by default kg=0.05:
    kg: KG error in percent, above 0: 100 |A - B| / |A - mean of each frame of A|.
    max_error: largest error of any coordinate, never exceeded, above 0, in units of the positions; or, as "0.01%", in
        parts of the diagonal of the box around all positions.
    bpvf: bits per vertex and frame, the whole file counted, above 0.
    size: bytes of the file, never exceeded.
    lossless: every bit of every float32 position is kept.

    profile: "main" is the smallest, "fast" decodes several times as quick, "thesis" is for comparison.
    effort: 1 (quickest) to 9 (smallest).
    fps: frames per second. start_time: of the first frame, in frames.
    attributes: what vertices, corners, faces or the shot carry: name: (domain, values) or Attribute.
    resources: files that travel along: name: (media type, bytes). metadata: free keys and values.
    group_length: frames that decode together, 1 to 65536; 0 = chosen. open_groups: how many of them in a row may
        continue the one before, 0 to 63; -1 = chosen.
    reorder: the order of vertices is not kept (smaller).
    regions: of the motion model, 0 = none, -1 = decided.
    threads: 0 = one for each core; the bytes do not depend on it.
    note_errors: the file tells its target and measured errors, and the boxes of its groups.
    progress: called now and then with the part that is done, 0 to 1; what it raises ends the encoding.

    Ctrl-C ends it, too. ValueError where an argument is wrong: it says which and where.
    """
    xyz, rounding = positions_of(positions)
    sizes, corners = faces_of(faces, xyz.shape[1])
    counts = {"vertex": xyz.shape[1], "corner": len(corners), "face": len(sizes), "shot": 1}
    choices = choices_of(kg, max_error, bpvf, size, lossless, xyz, profile, effort)
    wanted = choices["value"]
    if choices["target"] == "max_error" and rounding > 0:
        if wanted <= rounding:
            raise ValueError(f"max_error: {wanted:g} is out of reach, since float32 alone rounds positions by up to "
                             f"{rounding:g}; subtract an offset from all frames, or allow more")
        choices["value"] = wanted - rounding
    choices.update(group_length=group_length, open_groups=open_groups, reorder=reorder, regions=regions,
                   threads=threads, report=note_errors)
    about = about_of(fps, start_time, metadata)
    about["attributes"] = attributes_of(attributes, counts, len(xyz))
    about["resources"] = [(name, kind, bytes(data)) for name, (kind, data) in resources.items()]
    data, figures = _core.encode(xyz, sizes, corners, about, choices, progress)
    result = report_of(figures, choices["target"].replace("_", "-"), wanted, rounding)
    if path is not None:
        write_whole(path, data)
        return result
    encoded = Encoded(data)
    encoded.report = result
    return encoded


def choices_of(kg: Optional[float], max_error: Union[float, str, None], bpvf: Optional[float], size: Optional[int],
               lossless: bool, xyz: Optional[FloatArray], profile: str, effort: int) -> Dict[str, Any]:
    """Target, value, profile and effort, checked."""
    given = {name: value for name, value in (("kg", kg), ("max_error", max_error), ("bpvf", bpvf), ("size", size))
             if value is not None}
    if len(given) + lossless > 1:
        names = [*given, *(["lossless"] if lossless else [])]
        raise ValueError(f"{' and '.join(names)}: there is one target")
    if profile not in PROFILES:
        raise ValueError(f"profile: is one of {', '.join(PROFILES)}, not {profile!r}")
    if not 1 <= effort <= 9:
        raise ValueError(f"effort: is 1 to 9, not {effort}")
    if lossless:
        return {"target": "lossless", "value": None, "profile": profile, "effort": effort}
    name, value = next(iter(given.items()), ("kg", DEFAULT_KG))
    number = _part_of_diagonal(value, xyz) if isinstance(value, str) else float(value)
    if not 0 < number < float("inf"):
        raise ValueError(f"{name}: has to be a number above 0, not {value}")
    return {"target": name, "value": number, "profile": profile, "effort": effort}


def _part_of_diagonal(text: str, xyz: Optional[FloatArray]) -> float:
    try:
        percent = float(text[:-1]) if text.endswith("%") else None
    except ValueError:
        percent = None
    if percent is None or xyz is None:
        raise ValueError(f"max_error: is a number or a part of the diagonal such as '0.01%', not {text!r}")
    every = xyz.reshape(-1, 3)
    low, high = every.min(axis=0).astype(float), every.max(axis=0).astype(float)
    return percent / 100 * float(np.linalg.norm(high - low))


def about_of(fps: Optional[float], start_time: float, metadata: Mapping[str, str]) -> Dict[str, Any]:
    if fps is not None and not 0 < fps < float("inf"):
        raise ValueError(f"fps: has to be a number above 0, not {fps}")
    if not np.isfinite(start_time):
        raise ValueError(f"start_time: has to be finite, not {start_time}")
    return {"fps": float(fps or 0), "start_time": float(start_time), "metadata": dict(metadata)}


def write_whole(path: Path, data: bytes) -> None:
    """Under another name until it is whole."""
    name = unfinished(path)
    try:
        with open(name, "wb") as file:
            file.write(data)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


def unfinished(path: Path) -> str:
    """An empty file beside the one that it will replace, with its permissions."""
    folder, base = os.path.split(os.fspath(path))
    handle, name = tempfile.mkstemp(prefix=f".{base}.", dir=folder or ".")
    os.close(handle)
    mask = os.umask(0)
    os.umask(mask)
    os.chmod(name, 0o666 & ~mask)
    return name
