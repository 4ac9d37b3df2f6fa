#!/usr/bin/env python3
"""sequences_set.py FOLDER > LIST: every tenth frame of the sequences in the folder, NAME/NAME.pc2, and variants of frames between them."""

import pathlib
import struct
import sys

NAMES = ['chicken', 'cow', 'dance', 'horse', 'samba', 'facecap', 'heart', 'curtain']
ONCE = ['rotated', 'scaled', 'noise_0.5', 'decimated_2', 'resampled', 'holes']
TWICE = ['noise_1', 'decimated_10', 'half']


def frame_count(path):
    """The last number of a point cache's header."""
    with open(path, 'rb') as cache:
        return struct.unpack('<12s2i2fi', cache.read(32))[-1]


def main():
    for name in NAMES:
        path = pathlib.Path(sys.argv[1], name, f'{name}.pc2')
        frames = range(1, frame_count(path) + 1, 10)
        third, two_thirds = frames[len(frames) // 3], frames[2 * len(frames) // 3]
        shapes = [(frame, '-') for frame in frames] + [(third, variant) for variant in ONCE + TWICE]
        shapes += [(two_thirds, variant) for variant in TWICE]
        for frame, variant in shapes:
            print(name, path, frame, variant, sep='\t')


if __name__ == '__main__':
    main()
