#!/usr/bin/env python3
"""Compares the bytes that spec/example.md explains with the stream they are of. Exits with 1 where they differ."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROW = re.compile(r"^\| (\d+) \| `([0-9A-F ]+)` \|")


def main():
    explained = b""
    for line in (ROOT / "spec/example.md").read_text().splitlines():
        row = ROW.match(line)
        if row is None:
            continue
        if int(row[1]) != len(explained):
            sys.exit("example.md: a row starts at %s, not at %d" % (row[1], len(explained)))
        explained += bytes.fromhex(row[2])
    stream = (ROOT / "conformance/streams/uncommon/example.reeb").read_bytes()
    if explained != stream:
        sys.exit("example.md explains %d bytes, which are not the %d of example.reeb" % (len(explained), len(stream)))


if __name__ == "__main__":
    main()
