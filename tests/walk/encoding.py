"""C: the encoder. E: its defaults."""
import array
import json
import math
import random
import struct

from demands import cache, grid, obj

SIDE = 20
DIAGONAL = math.hypot(SIDE, SIDE)


def wave(t, side=SIDE, scale=1.0):
    return [c for y in range(side) for x in range(side)
            for c in (x * scale, y * scale, scale * 0.5 * math.sin(0.7 * x + 0.3 * y + 0.4 * t))]


def sequence(w, frames, side=SIDE):
    vertices, faces = grid(side)
    w.write("m.obj", obj(vertices, faces))
    w.write("m.pc2", cache(side * side, frames))


def encode(w, *options):
    """Exit code, bytes and message."""
    done = w.run("encode", "m.pc2", "-o", "m.reeb", "-f", *options)
    return done.code, len(w.read("m.reeb")) if done.code == 0 else None, done.err


def far_away(w):
    for reach in (1e2, 1e5, 1e6, 1e8):
        w.demand(f"C: a frame {reach:g} diagonals away takes no more than without a loss")
        frames = [wave(t) for t in range(16)]
        frames[7] = [c + reach * DIAGONAL for c in frames[7]]
        sequence(w, frames)
        exact = encode(w, "--lossless")[1]
        code, size, message = encode(w)
        w.expect(("a file", exact), (code, size, message), code == 0 and size <= exact)
    for where, places in (("all frames", range(16)), ("one frame", [7])):
        w.demand(f"C: a vertex far away in {where} costs little under --max-error, and is told of under --kg")
        frames = [wave(t) for t in range(16)]
        sequence(w, frames)
        plain = encode(w, "--max-error", "0.001")[1]
        for reach in (1e2, 1e4, 1e6):
            frames = [wave(t) for t in range(16)]
            for t in places:
                frames[t][3 * 210] += reach * DIAGONAL
            sequence(w, frames)
            code, size, message = encode(w, "--max-error", "0.001")
            w.expect((reach, f"at most 1.3 * {plain}"), (code, size), code == 0 and size <= 1.3 * plain)
            code, size, message = encode(w)
            told = "hardly count" in message or "lossless" in message
            w.expect((reach, "a word from 1e4 on"), (code, message), code == 0 and (told or reach < 1e4))


def fine_errors(w):
    for title, offset, scale in [("plain", 0, 1), ("far from 0", 1000, 1), ("tiny", 0, 2.0 ** -30), ("large", 0, 2.0 ** 60)]:
        w.demand(f"C: targets below what reconstruction reaches, {title}")
        sequence(w, [[(c + offset) * scale for c in wave(t)] for t in range(12)])
        exact = encode(w, "--lossless")[1]
        for options in (["--kg", "1e-5"], ["--kg", "1e-9"], ["--kg", "1e-30"], ["--max-error", repr(1e-9 * scale)],
                        ["--max-error", "1e-30"], ["--max-error", "1e-44"], ["--max-error", "1e-12%"]):
            code, size, message = encode(w, *options)
            good = code == 0 and size <= exact + 150 and "0.000000" not in message
            w.expect((*options, f"at most {exact} and a report"), (code, size, message), good)
    for digits in (0, 1, 2):
        w.demand(f"C: coordinates of {digits} decimals take no more than without a loss, whatever the target")
        sequence(w, [[round(c, digits) for c in wave(t, scale=10)] for t in range(12)])
        exact = encode(w, "--lossless")[1]
        for options in ([], ["--max-error", "1e-3"], ["--kg", "0.001"], ["--bpvf", "30"], ["--size", "100k"]):
            code, size, message = encode(w, *options)
            w.expect((*options, f"at most {exact} and a report"), (code, size, message), code == 0 and size <= exact + 150)
    for title, frames in [("at one place", [[1.5, -2, 3] * SIDE * SIDE] * 3), ("at 0", [[0.0, 0, 0] * SIDE * SIDE] * 3),
                          ("in motion", [[t, 2 * t, 0] * SIDE * SIDE for t in range(3)])]:
        w.demand(f"C: a sequence without extent, {title}")
        sequence(w, frames)
        for options in ([], ["--max-error", "0.01%"], ["--kg", "0.1"], ["--bpvf", "8"], ["--size", "1k"]):
            code, _, message = encode(w, *options)
            w.expect((*options, 0), (code, message), code == 0)


def targets(w):
    w.demand("C: targets are met")
    sequence(w, [wave(t) for t in range(20)])
    for option, value, key in [("--kg", 0.5, "kg"), ("--kg", 0.01, "kg"), ("--max-error", 0.01, "max_error")]:
        encode(w, option, str(value))
        seen = json.loads(w.run("compare", "m.pc2", "m.reeb", "--json").out)
        w.expect((option, value), seen[key], seen[key] <= value)
    for bytes_wanted in (1000, 3000, 20000):
        code, size, message = encode(w, "--size", str(bytes_wanted))
        w.expect(f"at most {bytes_wanted}", (code, size, message), code == 0 and size <= bytes_wanted)
    code, _, message = encode(w, "--size", "100")
    w.expect((1, "the nearest"), (code, message), code == 1 and "bytes" in message)


def binary32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def frame_grids(w):
    chance = random.Random(5)
    frames = []
    for t in range(24):
        origin = [binary32(chance.uniform(-3, 0)) for _ in range(3)]
        step = [binary32(chance.uniform(1.0, 1.2) * extent / 255) for extent in (23, 23, 4.2)]
        frames.append([binary32(binary32(step[i % 3] * round((c - origin[i % 3]) / step[i % 3])) + origin[i % 3])
                       for i, c in enumerate(wave(t))])
    w.demand("C: frames on grids of 256 levels, each with step and origin of its own: 24 bits at most")
    sequence(w, frames)
    code, size, _ = encode(w, "--lossless")
    bits = 8 * size / (SIDE * SIDE * 24)
    w.expect("at most 24 bits a vertex and frame", (code, bits), bits <= 24)


def units(w):
    w.demand("C: segmentation does not depend on the unit")
    w.run("sample", "creature", "--length", "12", "-o", "c.pc2")
    data = w.read("c.pc2")
    w.write("s.obj", w.read("c.obj"))
    said = w.run("segment", "c.pc2", "-o", "c.ply").err.splitlines()[0]
    for power in (-60, -30, -20, 60):
        scaled = array.array("f", [x * 2.0 ** power for x in array.array("f", data[32:])])
        w.write("s.pc2", data[:32] + scaled.tobytes())
        w.expect((power, said), (power, w.run("segment", "s.pc2", "-o", "s.ply", "-f").err.splitlines()[0]))


def defaults(w):
    w.demand("E: a long sequence is in groups that play while they arrive")
    w.run("sample", "mechanism", "--length", "400", "-o", "m.pc2")
    encode(w, "--effort", "1")
    groups = json.loads(w.run("info", "m.reeb", "--json").out)["groups"]
    w.expect("four or more", len(groups), len(groups) >= 4)


STEPS = [far_away, fine_errors, targets, frame_grids, units, defaults]
