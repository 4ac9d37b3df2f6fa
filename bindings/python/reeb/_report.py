"""The figures of an encoding."""

import builtins
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Union

from . import _core
from ._types import Path


@dataclass(frozen=True)
class Report:
    """Figures of a file, of what decodes from it against what was encoded. None: the file does not tell."""

    bytes: int  #: of the file
    bpvf: float  #: bits per vertex and frame, every byte of the file counted
    kg: Optional[float]  #: KG error in percent: 100 |A - B| / |A - mean of each frame of A|
    rmse: Optional[float]  #: root of the mean squared displacement of a vertex, in units of the input
    max_error: Optional[float]  #: largest error of a coordinate, in units of the input
    target: Optional[str]  #: what was aimed at: "kg", "max-error", "bpvf", "size" or "lossless"
    wanted: Optional[float]  #: the target's value, in its unit
    rounding: float = 0.0  #: by how much float64 input was rounded at most, which is beside the errors above
    sections: Dict[str, int] = field(default_factory=dict)  #: bytes of each part of the file
    notes: List[str] = field(default_factory=list)  #: sentences, e.g. where the coding became lossless


def report_of(figures: Dict[str, Any], target: str, wanted: Optional[float], rounding: float) -> Report:
    notes = list(figures.pop("notes"))
    if rounding > 0:
        notes.append(f"positions were rounded from float64 to float32, by up to {rounding:.3g}")
    return Report(**figures, target=target, wanted=wanted, rounding=rounding, notes=notes)


def report(source: Union[Path, bytes]) -> Report:
    """The figures that a `.reeb` file, or its bytes, tells: sizes, and the errors noted when it was encoded."""
    if isinstance(source, (str, os.PathLike)):
        with builtins.open(source, "rb") as file:
            source = file.read()
    figures = _core.report(source)
    if figures["target"] in (None, "lossless"):
        figures["wanted"] = None
    return Report(**figures)
