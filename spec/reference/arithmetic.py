"""Arithmetic of README.md section 2.

Python's floats are binary64. An operation of binary32 is done in binary64 and rounded once more: of +, -, *, / and square
root on binary32 values that gives the binary32 result, since 53 >= 2 * 24 + 2 binary digits leave no tie to go wrong.
"""
import math
import struct

BINARY32 = struct.Struct("<f")


def f32(x):
    """x rounded to binary32, ties to even; what is too large becomes infinite."""
    try:
        return BINARY32.unpack(BINARY32.pack(x))[0]
    except OverflowError:
        return math.copysign(math.inf, x)


def clamp(x, low, high):
    return max(low, min(high, x))


def divide(a, b):
    """a / b of integers, truncated; b > 0."""
    return a // b if a >= 0 else -(-a // b)


def floor_log2(x):
    return x.bit_length() - 1


def log2_5(x):
    """Logarithm in 1/32, prediction.md."""
    m = floor_log2(x)
    return 32 * m + ((x << 5) >> m) - 32


def product32(a, b):
    return f32(a * b)


def sum32(a, b):
    return f32(a + b)
