#!/usr/bin/env python3
"""Encodes a simulation made with NumPy, with its velocity as an animated field, and reads it again."""

import sys

import numpy as np
from numpy.typing import NDArray

import reeb


def simulate(frames: int = 96, side: int = 40) -> "tuple[NDArray[np.float32], NDArray[np.float32]]":
    """Heights of a membrane after a blow, by the wave equation, and their velocity: [frames, side, side]."""
    height, velocity = np.zeros((side, side)), np.zeros((side, side))
    velocity[side // 3:side // 2, side // 4:side // 2] = 1
    heights, velocities = [], []
    for _ in range(frames):
        for _ in range(4):
            bend = sum(np.roll(height, shift, axis) for shift in (-1, 1) for axis in (0, 1)) - 4 * height
            velocity += 0.25 * bend
            height = height + 0.25 * velocity
            height[[0, -1]] = height[:, [0, -1]] = 0
        heights.append(height)
        velocities.append(velocity.copy())
    return np.array(heights, np.float32), np.array(velocities, np.float32)


def main() -> None:
    path = sys.argv[1] if len(sys.argv) > 1 else "membrane.reeb"
    heights, velocities = simulate()
    frames, side = heights.shape[:2]
    y, x = np.mgrid[:side, :side].astype(np.float32)
    positions = np.stack(np.broadcast_arrays(x, y, heights), axis=-1).reshape(frames, -1, 3)
    corner = np.arange(side * side).reshape(side, side)
    quads = np.stack((corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]), axis=-1).reshape(-1, 4)

    report = reeb.encode(positions, quads, path, kg=0.05, fps=24, progress=lambda done: print(f"\r{done:4.0%}", end=""),
                         attributes={"velocity": ("vertex", velocities.reshape(frames, -1), "error:0.001")})
    print(f"\r{path}: {report.bytes:,} bytes, {positions.nbytes / report.bytes:.0f} times smaller, KG {report.kg:.3g} %")

    with reeb.open(path) as seq:
        print(seq)
        print("largest error of a coordinate", np.abs(seq[:] - positions).max())
        print("largest error of the velocity", np.abs(seq.attribute("velocity")[:] - velocities.reshape(frames, -1)).max())


if __name__ == "__main__":
    main()
