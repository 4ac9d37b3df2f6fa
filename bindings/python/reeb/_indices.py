"""Frames as the caller names them."""

import operator
from typing import Any, Iterator, Tuple

import numpy as np

from ._types import AnyArray


def frame_index(index: Any, count: int, what: str = "frame") -> int:
    """An index from the front; negative ones count from the end."""
    number = operator.index(index)
    if not -count <= number < count:
        raise IndexError(f"{what} {number} is out of range: there are {count}")
    return number % count


def frame_indices(frames: Any, count: int) -> Tuple[AnyArray, bool]:
    """The numbers of frames, and whether it is one by its own: from an index, a slice, or an array of indices or of
    booleans."""
    if isinstance(frames, slice):
        return np.arange(*frames.indices(count)), False
    if not isinstance(frames, (list, np.ndarray)) and hasattr(frames, "__index__"):
        return np.array([frame_index(frames, count)]), True
    numbers = np.asarray(frames)
    if numbers.size == 0:
        return np.empty(0, np.int64), False
    if numbers.dtype == bool:
        if numbers.shape != (count,):
            raise IndexError(f"frames: a mask has {count} values, not {list(numbers.shape)}")
        return np.flatnonzero(numbers), False
    if numbers.dtype.kind not in "iu":
        raise TypeError(f"frames are whole numbers, a slice or a mask, not {numbers.dtype}")
    if numbers.ndim != 1:
        raise IndexError("frames: one dimension is allowed")
    bad = (numbers < -count) | (numbers >= count)
    if bad.any():
        raise IndexError(f"frame {numbers[bad][0]} is out of range: there are {count}")
    return np.where(numbers < 0, numbers + count, numbers).astype(np.int64), False


def runs(numbers: AnyArray) -> Iterator[Tuple[int, int, int]]:
    """(place, first frame, count) of frames that follow each other in the array and in the sequence, in the order of
    the sequence, so that each group is decoded once."""
    if len(numbers) == 0:
        return
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    cuts = np.flatnonzero((np.diff(ordered) != 1) | (np.diff(order) != 1)) + 1
    starts = np.concatenate(([0], cuts))
    ends = np.append(cuts, len(numbers))
    for start, end in zip(starts, ends):
        yield int(order[start]), int(ordered[start]), int(end - start)
