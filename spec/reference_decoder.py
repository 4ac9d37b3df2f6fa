#!/usr/bin/env python3
"""Reference decoder of the Reeb format: slow, plain, in the order of the specification.

    reference_decoder.py STREAM [OUT]

Written from the chapters beside it, not from the product's sources; it needs Python 3.8 and nothing else.

Frames are written to OUT in the form of conformance/README.md; without OUT, their hashes are printed, one line a frame.
The exit code is that of the result, conformance/README.md.
"""
import argparse
import hashlib
import struct
import sys

from reference.container import read_file
from reference.errors import Refused
from reference.group import Decoder

EXIT_CODES = {"ok": 0, "corrupt": 3, "truncated": 4, "unsupported": 5, "limit exceeded": 6}


def pack_positions(positions):
    return b"".join(struct.pack("<3f", *p) for p in positions)


def pack_connectivity(vertex_count, faces):
    sizes = [len(face) for face in faces]
    corners = [corner for face in faces for corner in face]
    numbers = [vertex_count, len(sizes), len(corners)] + sizes + corners
    return struct.pack("<%dI" % len(numbers), *numbers)


def write_attribute(out, t, index, values):
    if out is not None:
        out.write(struct.pack("<4I", 0xFFFFFFFF, t, index, len(values)) + values)
    else:
        print(t, "attribute", index, hashlib.sha256(values).hexdigest(), flush=True)


def write_frame(out, t, connectivity, positions):
    if out is not None:
        out.write(struct.pack("<I", t) + connectivity + positions)
    else:
        print(t, hashlib.sha256(positions).hexdigest(), hashlib.sha256(connectivity).hexdigest(), flush=True)


def decode_frames(file, out):
    """Writes every frame that decodes; the result of the first that does not, or of the file."""
    decoder = Decoder(file)
    result = "truncated" if file.truncated else "ok"
    lost = set()  # groups that do not decode
    written = set()  # static attributes: shot and index
    for t in range(file.total_frames):
        group = next((g.first_frame for g in file.groups if g.first_frame <= t < g.first_frame + g.frame_count), t)
        if group in lost:
            continue
        try:
            positions, faces = decoder.frame(t)
        except Refused as fault:
            lost.add(group)
            report(fault)
            result = fault.name if result == "ok" else result
            continue
        write_frame(out, t, pack_connectivity(len(positions), faces), pack_positions(positions))
        fault = decode_attributes(decoder, t, written, out)
        result = fault if result == "ok" else result
    return result


def decode_attributes(decoder, t, written, out):
    """Writes the attributes of a frame, static ones once a shot; the result."""
    result = "ok"
    for attribute in decoder.attributes(t):
        key = (attribute.shot, attribute.index)
        if not attribute.animated() and key in written:
            continue
        written.add(key)
        try:
            write_attribute(out, t, attribute.index, decoder.attribute(attribute, t))
        except Refused as fault:
            report(fault)
            result = fault.name if result == "ok" else result
    return result


def report(fault):
    print("%s: %s" % (fault.name, fault), file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description="Decodes a .reeb stream by the specification, slowly.")
    parser.add_argument("stream")
    parser.add_argument("out", nargs="?", help="frames in the form of conformance/README.md")
    arguments = parser.parse_args()
    with open(arguments.stream, "rb") as file:
        data = file.read()
    out = open(arguments.out, "wb") if arguments.out else None
    try:
        result = decode_frames(read_file(data), out)
    except Refused as fault:
        report(fault)
        result = fault.name
    if out is not None:
        out.close()
    return EXIT_CODES[result]


if __name__ == "__main__":
    sys.exit(main())
