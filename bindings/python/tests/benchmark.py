#!/usr/bin/env python3
"""Frames per second of the package beside those of the C library, and of two threads beside one.

    tests/benchmark.py BUILD/bindings/libreeb.so FILE.reeb [ROUNDS]

The C library is called through ctypes, 16 frames at once into one buffer; all take turns, and the least time of each
counts: seconds of the processor, so that other work on the machine hardly matters, but for the two last lines, which
are told in seconds of the clock and want two idle cores. Opening is not counted, decoding of the groups is: nothing is
kept from round to round.
"""
import ctypes
import sys
import threading
import time

import numpy as np

import reeb


class Limits(ctypes.Structure):
    _fields_ = [("counts", ctypes.c_uint32 * 3), ("max_memory", ctypes.c_uint64)]


class Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_size_t), ("limits", Limits), ("threads", ctypes.c_uint32),
                ("prefetch", ctypes.c_int), ("cache_bytes", ctypes.c_uint64), ("callbacks", ctypes.c_void_p * 6),
                ("message_size", ctypes.c_size_t)]


def c_library(path, data, frames, vertices):
    library = ctypes.CDLL(path)
    out = np.empty((16, vertices, 3), np.float32)
    options = Options(struct_size=ctypes.sizeof(Options), prefetch=1, cache_bytes=1)

    def run():
        decoder = ctypes.c_void_p()
        assert library.reeb_open_memory(data, ctypes.c_size_t(len(data)), ctypes.byref(options),
                                        ctypes.byref(decoder)) == 0
        start = time.process_time()
        for first in range(0, frames, 16):
            assert library.reeb_get_frames(decoder, first, min(16, frames - first),
                                           ctypes.c_void_p(out.ctypes.data), ctypes.c_size_t(vertices * 3)) == 0
        took = time.process_time() - start
        library.reeb_close(decoder)
        return took

    return run


def timed(data, use):
    def run():
        with reeb.open(data, cache_bytes=0) as sequence:
            start = time.process_time()
            use(sequence)
            return time.process_time() - start

    return run


def iterate(sequence):
    for _ in sequence:
        pass


def one_by_one(sequence):
    for i in range(len(sequence)):
        sequence[i]


def on_threads(data, count):
    def work():
        with reeb.open(data, cache_bytes=0, prefetch=False) as sequence:
            iterate(sequence)

    def run():
        threads = [threading.Thread(target=work) for _ in range(count)]
        start = time.perf_counter()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return time.perf_counter() - start

    return run


def main():
    library, path = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    with open(path, "rb") as file:
        data = file.read()
    with reeb.open(data) as sequence:
        print(sequence)
        frames, vertices = len(sequence), sequence.vertex_count
        out = np.empty((frames, vertices, 3), np.float32)
    runs = {
        "C library, 16 frames at once": c_library(library, data, frames, vertices),
        "for frame in seq": timed(data, iterate),
        "seq.positions(out=...)": timed(data, lambda sequence: sequence.positions(out=out)),
        "seq[:]": timed(data, lambda sequence: sequence[:]),
        "seq[i], one by one": timed(data, one_by_one),
        "one thread, one file": on_threads(data, 1),
        "two threads, two files": on_threads(data, 2)
    }
    best = {name: min(times) for name, times in zip(runs, zip(*([run() for run in runs.values()] for _ in range(rounds))))}
    reference = frames / best["C library, 16 frames at once"]
    for name, seconds in best.items():
        rate = frames * (2 if name.startswith("two") else 1) / seconds
        print(f"{name:30} {rate:9.0f} frames/s  {rate / reference:5.2f} of the C library")


if __name__ == "__main__":
    main()
