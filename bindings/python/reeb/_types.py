"""Types of arguments and results."""

import os
from typing import Any, Protocol, Union

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]
IndexArray = NDArray[np.uint32]
AnyArray = NDArray[Any]
Path = Union[str, "os.PathLike[str]"]


class BinaryFile(Protocol):
    """What a file is read through: an open file, io.BytesIO, a file of fsspec."""

    def read(self, size: int = ..., /) -> bytes: ...

    def seek(self, offset: int, whence: int = ..., /) -> int: ...
