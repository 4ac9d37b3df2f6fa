#!/usr/bin/env python3
"""obj_round_trip.py REEB: OBJ frames with all that OBJ has come back through a .reeb file as they were.

Both sides are read by the few lines below, which share nothing with the reader and the writer under test.
"""
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

LISTS = ("v", "vt", "vn")


def single(x):
    return struct.unpack("f", struct.pack("f", float(x)))[0]


def read(path):
    """Lists of v, vt and vn; faces as (corners, state); names of libraries."""
    lists, faces, libraries = {key: [] for key in LISTS}, [], []
    state = {"usemtl": "", "g": "", "o": "", "s": "off"}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            key, *words = line.split() or ["#"]
            if key in lists:
                lists[key].append(tuple(single(w) for w in words))
            elif key in state:
                state[key] = " ".join(words)
            elif key == "mtllib":
                libraries.append(" ".join(words))
            elif key == "f":
                corners = []
                for word in words:
                    parts = (word.split("/") + ["", ""])[:3]
                    index = [int(p) if p else None for p in parts]
                    corners.append(tuple(i if i is None or i > 0 else len(lists[k]) + 1 + i for i, k in zip(index, LISTS)))
                faces.append((tuple(corners), tuple(sorted(state.items()))))
    return lists, faces, libraries


def values(frame):
    """Faces with the values of their corners, the least vertex first, sorted."""
    lists, faces, _ = frame
    out = []
    for corners, state in faces:
        first = min(range(len(corners)), key=lambda i: [c[0] for c in corners[i:] + corners[:i]])
        turned = corners[first:] + corners[:first]
        out.append(([c[0] for c in turned],
                    [tuple(i and lists[k][i - 1] for i, k in zip(c[1:], LISTS[1:])) for c in turned], state))
    return sorted(out, key=lambda face: face[0])


def angle(a, b):
    dot = sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)
    return math.degrees(math.acos(max(-1, min(1, dot))))


def check_near(before, after, texture_error, normal_angle):
    assert before[2] == after[2], "libraries"
    left, right = values(before), values(after)
    assert len(left) == len(right)
    for a, b in zip(left, right):
        assert a[0] == b[0] and a[2] == b[2], (a, b)
        for (vt_a, vn_a), (vt_b, vn_b) in zip(a[1], b[1]):
            assert (vt_a is None) == (vt_b is None) and (vn_a is None) == (vn_b is None)
            if vt_a is not None:
                assert max(abs(x - y) for x, y in zip(vt_a, vt_b)) <= texture_error, (vt_a, vt_b)
            if vn_a is not None:
                assert vn_a == vn_b or angle(vn_a, vn_b) <= normal_angle, (vn_a, vn_b)


def normal(points):
    u = [b - a for a, b in zip(points[0], points[1])]
    w = [b - a for a, b in zip(points[0], points[2])]
    n = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
    return tuple(x / math.hypot(*n) for x in n)


def box_frame(t):
    """A box that turns and stretches: a normal for each face, whose lists differ from frame to frame."""
    turn, out = 0.2 * t, ["mtllib box_%d.mtl" % t, "o box"]
    points = []
    for corner in range(8):
        x, y, z = (2 * (corner >> i & 1) - 1 for i in range(3))
        y *= 1 + 0.1 * t
        points.append((x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn), z))
    out += ["v %.6g %.6g %.6g %.3g %.3g %.3g" % (p + tuple(c >> i & 1 for i in range(3))) for c, p in enumerate(points)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    order = list(range(6))
    random.Random(t).shuffle(order)
    out += ["vt %g %g" % (0.25 * (i % 4), 0.5 * (i // 4) + (0.1 * t if i == 7 else 0)) for i in range(8)]
    out += ["vn %.5f %.5f %.5f" % normal([points[v] for v in sides[s]]) for s in order]
    for s, side in enumerate(sides):
        if s % 2 == 0:
            out += ["usemtl " + ("red", "green#2", "white")[s // 2], "s " + ("off", "1", "2")[s // 2]]
        if s == 3:
            out += ["g upper half"]
        texture = [] if s == 4 else [(v + s) % 8 + 1 for v in side]
        out.append("f " + " ".join("%d/%s/%d" % (v + 1, texture[i] if texture else "", order.index(s) + 1)
                                   for i, v in enumerate(side)))
    return "\n".join(out) + "\n"


def main():
    reeb = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(folder + "/in")
        for t in range(1, 13):
            with open("%s/in/f_%d.obj" % (folder, t), "w", encoding="utf-8") as out:
                out.write(box_frame(t))
        with open(folder + "/in/box_3.mtl", "w", encoding="utf-8") as out:
            out.write("newmtl red\n")
        for options, texture_error, normal_angle in (["--lossless"], 0, 0), (["--max-error", "0.001"], 1 / 8192, 0.15):
            for embed in [], ["--embed"]:
                subprocess.run([reeb, "encode", folder + "/in", "-o", folder + "/a.reeb", "-f", "-q", *options, *embed],
                               check=True)
                target = "%s/out%d%d" % (folder, len(options), len(embed))
                subprocess.run([reeb, "decode", folder + "/a.reeb", "-o", target + "/f_%d.obj", "-q"], check=True)
                for t in range(1, 13):
                    before, after = (read("%s/f_%d.obj" % (f, t)) for f in (folder + "/in", target))
                    check_near(before, after, texture_error, normal_angle)
                    if normal_angle == 0:
                        assert before[:2] == after[:2], "lists in frame %d" % t
                assert os.path.exists(target + "/box_3.mtl") == bool(embed)
    print("as they were")


main()
