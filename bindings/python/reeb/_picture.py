"""A sequence as a picture, for notebooks."""

import os
import subprocess
import sys
import tempfile
from typing import TYPE_CHECKING, Optional

import numpy as np

from ._encode import encode

if TYPE_CHECKING:
    from ._sequence import Sequence

_SHOWN = 4  # frames
_MOST_VERTICES = 200_000  # a notebook should not wait


def picture(sequence: "Sequence") -> Optional[bytes]:
    """A PNG of some frames of the first shot, drawn by the command line; None where it cannot be."""
    if sequence.closed or not sequence.shots or sequence.shots[0].vertex_count > _MOST_VERTICES:
        return None
    shot = sequence.shots[0]
    frames = np.unique(np.linspace(shot.first_frame, shot.end_frame - 1, _SHOWN).round().astype(int))
    with tempfile.TemporaryDirectory() as folder:
        path, out = os.path.join(folder, "frames.reeb"), os.path.join(folder, "frames.png")
        encode(sequence[frames], shot.polygons, path, lossless=True, effort=1)
        done = subprocess.run([sys.executable, "-m", "reeb", "picture", path, "-o", out, "-q"], capture_output=True)
        if done.returncode != 0:
            return None
        with open(out, "rb") as file:
            return file.read()
