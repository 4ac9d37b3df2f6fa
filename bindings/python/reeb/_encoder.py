"""Frames one after another."""

import os
from dataclasses import replace
from types import TracebackType
from typing import Any, Dict, List, Mapping, Optional, Type, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._encode import Progress, about_of, choices_of, encode, unfinished
from ._input import faces_of, positions_of
from ._attributes import Polygons
from ._report import Report, report
from ._types import AnyArray, Path


class Encoder:
    """Writes a `.reeb` file from frames as they come:

        with reeb.Encoder("run.reeb", faces, lossless=True, fps=24) as encoder:
            for positions in simulation:
                encoder.add(positions)
        print(encoder.report.bytes)

    With `lossless=True` frames go to the file as they come, and memory stays that of a few groups of frames (64 MiB of
    positions each, or `group_length`), one for each thread. A target that allows errors is met over the whole sequence,
    so the frames are kept as they came, 12 bytes per vertex of float32, until the end, when they are encoded as by
    `encode`.

    Arguments are those of `encode`; of the fixed number of vertices `vertex_count` is told by the first frame. Nothing
    is at `path` before the end; where the `with` is left by an exception, nothing is there after it.
    """

    def __init__(self, path: Path, faces: Any, *, kg: Optional[float] = None, max_error: Union[float, str, None] = None,
                 bpvf: Optional[float] = None, size: Optional[int] = None, lossless: bool = False,
                 profile: str = "main", effort: int = 5, fps: Optional[float] = None, start_time: float = 0.0,
                 metadata: Mapping[str, str] = {}, group_length: int = 0, threads: int = 0,
                 progress: Optional[Progress] = None) -> None:
        targets = {"kg": kg, "max_error": max_error, "bpvf": bpvf, "size": size, "lossless": lossless}
        if not isinstance(max_error, str):
            choices_of(kg, max_error, bpvf, size, lossless, None, profile, effort)
        self._about = about_of(fps, start_time, metadata)
        self._path, self._faces = path, faces
        self._lossless = lossless
        self._effort, self._group_length, self._threads = effort, group_length, threads
        self._rest: Dict[str, Any] = {**targets, "profile": profile, "effort": effort, "fps": fps, "start_time": start_time,
                      "metadata": metadata, "group_length": group_length, "threads": threads, "progress": progress}
        self._writer: Optional[_core.LosslessWriter] = None
        self._unfinished: Optional[str] = None
        self._frames: List[AnyArray] = []
        self._rounding = 0.0
        self._closed = False
        self._report: Optional[Report] = None
        self.frame_count = 0  #: added so far
        self.vertex_count: Optional[int] = None

    def add(self, positions: ArrayLike) -> None:
        """The next frame, [vertices, 3], or frames, [frames, vertices, 3]."""
        if self._closed:
            raise ValueError("the encoder is closed")
        given = np.asarray(positions)
        if given.ndim == 3:
            for frame in given:
                self.add(frame)
            return
        try:
            xyz, rounding = positions_of(given, ndim=2)
            if self.vertex_count not in (None, len(xyz)):
                raise ValueError(f"positions: {len(xyz)} vertices, but frame 0 has {self.vertex_count}")
        except ValueError as error:
            raise ValueError(f"frame {self.frame_count}: {error}") from None
        self._rounding = max(self._rounding, rounding)
        if self.vertex_count is None:
            self._begin(len(xyz))
        if self._writer is not None:
            self._writer.add(xyz)
        else:
            self._frames.append(given.copy())
        self.frame_count += 1

    def _begin(self, vertex_count: int) -> None:
        sizes, corners = faces_of(self._faces, vertex_count)
        self.vertex_count = vertex_count
        if self._lossless:
            self._unfinished = unfinished(self._path)
            self._writer = _core.LosslessWriter(self._unfinished, vertex_count, sizes, corners, self._about,
                                                self._effort, self._group_length, self._threads)
        else:
            self._faces = Polygons(sizes, corners)

    def close(self) -> None:
        """Finishes the file. ValueError where no frame was added."""
        if self._closed:
            return
        if self.frame_count == 0:
            self._closed = True
            raise ValueError("positions: no frame was added")
        try:
            if self._writer is None:
                frames, self._frames = np.stack(self._frames), []
                self._report = encode(frames, self._faces, self._path, **self._rest)
            else:
                self._writer.finish()
                assert self._unfinished is not None
                self._report = replace(report(self._unfinished), kg=0.0, rmse=0.0, max_error=0.0, target="lossless",
                                       rounding=self._rounding)
                os.replace(self._unfinished, self._path)
                self._unfinished = None
        finally:
            self.discard()

    def discard(self) -> None:
        """Ends without a file."""
        self._closed = True
        self._writer = None
        self._frames = []
        if self._unfinished is not None:
            os.unlink(self._unfinished)
            self._unfinished = None

    @property
    def report(self) -> Report:
        """Figures of the file, once it is closed."""
        if self._report is None:
            raise ValueError("there is a report once the encoder is closed")
        return self._report

    def __enter__(self) -> "Encoder":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()
