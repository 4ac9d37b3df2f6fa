"""reeb.open."""

import builtins
import os
from typing import Union

from ._core import Stream
from ._sequence import Sequence
from ._types import BinaryFile, Path

_MiB = 1 << 20


def open(source: Union[Path, bytes, bytearray, memoryview, BinaryFile],
         *,
         threads: int = 1,
         prefetch: bool = True,
         cache_bytes: int = 256 * _MiB,
         max_memory: int = 4096 * _MiB) -> Sequence:
    """Opens a `.reeb` stream for reading.

    source: the path of a file; its bytes; or an object with `read` and `seek`, such as an open binary file or one of
        fsspec, which stays the caller's to close. Of files and objects only headers are read at first, each group of
        frames when it is needed; bytes are checked as a whole.
    threads: that decode a group, 0 = one for each core. Results do not depend on it.
    prefetch: the next group is decoded on a thread of its own while frames are asked for in sequence.
    cache_bytes: of decoded groups to keep; the least recently used go first.
    max_memory: bytes that the decoder may hold at once. A stream that takes more is refused (LimitError).

    Raises OSError where the source cannot be read, CorruptError, TruncatedError or UnsupportedError where it is no
    stream that this version reads. A damaged file opens if its first header is whole: see `gaps` and `truncated`.
    """
    if threads < 0 or cache_bytes < 0 or max_memory <= 0:
        raise ValueError("threads and cache_bytes are 0 or more, max_memory is above 0")
    # For the library 0 stands for a default, of threads and of bytes alike.
    options = (threads or os.cpu_count() or 1, prefetch, max(cache_bytes, 1), max_memory)
    if isinstance(source, (bytes, bytearray, memoryview)):
        stream = Stream("bytes", *options)
        stream.open_bytes(bytes(source))
    elif isinstance(source, (str, os.PathLike)):
        path = os.fspath(source)
        with builtins.open(path, "rb"):
            pass  # raises what Python raises where there is no such file
        stream = Stream(path, *options)
        stream.open_path(path)
    elif hasattr(source, "read") and hasattr(source, "seek"):
        stream = Stream(_name_of(source), *options)
        source.seek(0, os.SEEK_END)
        stream.open_file(source, source.tell() if hasattr(source, "tell") else source.seek(0, os.SEEK_CUR))
    else:
        raise TypeError(f"source is a path, bytes or an object with read and seek, not {type(source).__name__}")
    return Sequence(stream)


def _name_of(file: BinaryFile) -> str:
    for attribute in ("name", "path"):
        name = getattr(file, attribute, None)
        if isinstance(name, str):
            return name
    return type(file).__name__
