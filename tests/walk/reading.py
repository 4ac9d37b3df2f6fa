"""A: silent misreading. B: valid files refused."""
import struct

from demands import cache, grid, obj

PLACES = [(0, 0, 0), (1, 1, 1), (0, 1, 0)]  # of the triangle of `texts`
XYZ = "property float x\nproperty float y\nproperty float z\n"
LIST = "element face 1\nproperty list uchar int vertex_indices\n"
ROWS = "0 0 0\n1 1 1\n0 1 0\n3 0 1 2\n"
STL = ("solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 1 1\n   vertex 0 1 0\n  endloop\n"
       " endfacet\nendsolid a b\n")


def ply(body, vertex=XYZ, count=3, face=LIST, kind="ascii", end="\n"):
    head = f"ply\nformat {kind} 1.0\nelement vertex {count}\n{vertex}{face}end_header\n"
    return head.replace("\n", end).encode() + (body if isinstance(body, bytes) else body.encode())


def texts():
    """A triangle in every text format."""
    return {"a.obj": "v 0 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\n", "a.off": "OFF\n3 1 0\n" + ROWS, "a.ply": ply(ROWS).decode(),
            "a.stl": STL}


def binary_stl(announced=1, behind=b"", attribute=0):
    triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 1, 0, attribute)
    return b"solid of binary".ljust(80) + struct.pack("<I", announced) + triangle + behind


def expect_note(w, name, *patterns):
    w.expect_run(["encode", name, "-o", "o.reeb", "-f", "--lossless"], 0, *patterns)


def one_vertex_files(w, names):
    """Files whose only vertex has their place in `names` as x."""
    for i, name in enumerate(names):
        w.write(name, f"v {i} 0 0\n")


def order(w):
    for title, names in [
            ("negative, glued", ["f_-2.obj", "f_-1.obj", "f_0.obj", "f_1.obj"]),
            ("negative, behind a letter", ["t-2.obj", "t-1.obj", "t0.obj", "t1.obj"]),
            ("negative, padded", ["f_-010.obj", "f_-009.obj", "f_-008.obj"]),
            ("a dash before the number", ["walk-8.obj", "walk-9.obj", "walk-10.obj"]),
            ("decimal times", ["R-0.0005.obj", "R-0.001.obj", "R-0.0015.obj", "R-0.002.obj"]),
            ("decimal times from 0", ["t_0.obj", "t_0.25.obj", "t_0.5.obj", "t_0.75.obj", "t_1.obj"]),
            ("several numbers", ["take1_f0.obj", "take1_f1.obj", "take2_f0.obj", "take2_f1.obj"]),
            ("several numbers, ten behind nine", [f"s2_r{i}_v3.obj" for i in range(8, 12)]),
            ("a version behind", [f"f.{i:04d}.v2.obj" for i in range(98, 102)])]:
        w.demand(f"A1: order of a folder: {title}")
        one_vertex_files(w, names)
        w.expect(list(range(len(names))), w.order("."))
    w.demand("A1: %d finds negative numbers")
    one_vertex_files(w, ["f_-2.obj", "f_-1.obj", "f_0.obj", "f_1.obj"])
    w.expect([0, 1, 2, 3], w.order("f_%d.obj"))
    for title, names, missing in [
            ("a stray copy", ["f_1.obj", "f_2.obj", "f_2 copy.obj", "f_3.obj"], "f_2 copy.obj"),
            ("a stray without number", ["f_1.obj", "f_2.obj", "rest.obj", "f_3.obj"], "rest.obj"),
            ("a gap", ["f_1.obj", "f_2.obj", "f_5.obj"], "f_3.obj"),
            ("a gap, padded", ["f_0009.obj", "f_0011.obj"], "f_0010.obj"),
            ("a gap, negative", ["f_-3.obj", "f_-1.obj", "f_0.obj"], "f_-2.obj"),
            ("a gap, decimal", ["t_0.1.obj", "t_0.2.obj", "t_0.4.obj", "t_0.5.obj"], "t_0.2.obj and .*t_0.4.obj"),
            ("a gap in a take", ["take1_f0.obj", "take1_f2.obj", "take2_f0.obj", "take2_f1.obj"], "take1_f1.obj"),
            ("two with one number", ["f_1.obj", "f_01.obj", "f_2.obj"], "one frame number")]:
        w.demand(f"A1: a folder with {title} is an error")
        one_vertex_files(w, names)
        w.expect_refused(w.order("."), missing)
    w.demand("A1: files named one by one keep the order, and help says so")
    one_vertex_files(w, ["f_0.obj", "f_1.obj", "f_2.obj"])
    w.expect([2, 1, 0], w.order("f_2.obj", "f_1.obj", "f_0.obj"))
    w.expect([0, 2, 1], w.order("f_0.obj", "f_2.obj", "f_1.obj"))
    told = " ".join(w.run("help", "encode").out.decode().split())
    w.expect("in the order given", told, "in the order given" in told)
    w.demand("A1: files named one by one, decimal times")
    times = ["R-0.0005.obj", "R-0.001.obj", "R-0.0015.obj", "R-0.002.obj"]
    one_vertex_files(w, times)
    w.expect([0, 1, 2, 3], w.order(*times))


def odd_names(w):
    for name in ["[a]", "[a,b]", "a*b", "50%d", "what?", "a[1-3]b"]:
        w.demand(f"A1: a folder named {name}")
        one_vertex_files(w, [f"{name}/f_{i}.obj" for i in range(3)])
        w.expect([0, 1, 2], w.order(name))
        w.expect([0, 1, 2], w.order(f"{name}/*.obj"))
        w.expect([0, 1, 2], w.order(f"{name}/f_%d.obj"))
        w.expect([1], w.order(f"{name}/f_1.obj"))
    for name in ["f_[1].obj", "f_*.obj", "f_%d.obj", "f_?.obj", "f_%04d.obj"]:
        w.demand(f"A1: a file named {name}")
        one_vertex_files(w, [name, "f_1.obj", "f_2.obj", "f_0003.obj"])
        w.expect([0], w.order(name))


NUMBERS = {  # what a coordinate is, None where it is refused
    "1.5D+02": 150.0, "1.5d2": 150.0, "-2.5e-1": -0.25, "+3": 3.0, ".5": 0.5, "5.": 5.0, "1E3": 1000.0,
    "-1.#IND00": None, "1.#QNAN": None, "1.#INF": None, "2.5+3": None, "0,5": None, "1,000.5": None, "nan": None,
    "inf": None, "-inf": None, "0x10": None, "1e": None, "1e+": None, "1.2.3": None, "1f": None, "--1": None,
    "1_000": None, "1e999": None, "5;": None, "1/2": None, "'1'": None, "٣": None}


def numbers(w):
    for number, value in NUMBERS.items():
        w.demand(f"A2: a coordinate {number} {'is refused' if value is None else f'is {value}'}")
        for axis in range(3):
            row = ["1", "1", "1"]
            row[axis] = number
            for name, text in texts().items():
                w.write(name, text.replace("1 1 1", " ".join(row)))
                seen = w.points(name)
                if value is None:
                    w.expect_refused(seen, name, "line [0-9]+: |vertex 2 |triangle 1 ", ";|,")
                else:
                    w.expect((name, value), (name, seen[1][axis] if isinstance(seen, list) else seen))
    w.demand("A2: an index that is no index is refused")
    for text in ["f 1 2 3.5", "f 1 2 3x", "f 1 2 3,", "f 1 2 2+1", "f 1 2 0", "f 1 2 9", "f 1 2 -9", "f 1 2 1e0", "f", "v"]:
        w.write("a.obj", texts()["a.obj"].replace("f 1 2 3", text))
        w.expect_refused(w.points("a.obj"), "a.obj")
    for corners in ["3 0 1 2.5", "3 0 1 2x", "3 0 1 -1", "3 0 1 3", "3,0 1 2", "2.5 0 1 2"]:
        for name in ("a.off", "a.ply"):
            w.write(name, texts()[name].replace("3 0 1 2", corners))
            w.expect_refused(w.points(name), name)


def lines(w):
    for name, text in texts().items():
        kind = name[2:].upper()
        ends = ["\n", "\r\n", "\r"]
        mixed = "".join(line + ends[i % 3] for i, line in enumerate(text.splitlines()))
        for title, spelling in [("LF", text), ("CR", text.replace("\n", "\r")), ("CR LF", text.replace("\n", "\r\n")),
                                ("LF CR", text.replace("\n", "\n\r")), ("CR CR LF", text.replace("\n", "\r\r\n")),
                                ("mixed ends", mixed), ("no last end", text.rstrip("\n")), ("a UTF-8 mark", "\ufeff" + text),
                                ("tabs and double blanks", text.replace("1 1 1", "1\t1 \t 1  "))]:
            w.demand(f"A3: {kind} with {title}")
            w.write(name, spelling)
            w.expect(PLACES, w.points(name))
        for code in ("utf-16-le", "utf-16-be"):
            w.demand(f"A3: {kind} in {code} is refused, with its mark by name")
            w.write(name, ("\ufeff" + text).encode(code))
            w.expect_refused(w.points(name), "UTF-16")
            w.write(name, text.encode(code))
            w.expect_refused(w.points(name), name)
    for title, face in [("glued", "f 1 2 4\\\n 3"), ("glued at both sides", "f 1 2 4 \\\n3"), ("CR", "f 1 2 4\\\r 3"),
                        ("CR LF", "f 1 2 4\\\r\n 3"), ("blanks behind", "f 1 2 \\  \n4 3"), ("a tab behind", "f 1 2 4 \\\t\n3"),
                        ("twice", "f 1 \\\n2 \\\n4 3"), ("behind the keyword", "f \\\n1 2 4 3"),
                        ("glued to the keyword", "f\\\n1 2 4 3")]:
        w.demand(f"A3: an OBJ face that continues: {title}")
        w.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + face + "\n")
        w.expect([[1, 2, 4, 3]], w.faces("a.obj"))
    w.demand("A3: OBJ vertices and names that continue")
    w.write("a.obj", "g a \\\nb\no\\\nc\nv\\\n0 0 0\nv 1 \\\n1 1\nv 0\\\n 1 0\nf 1 2 3\n")
    w.expect(PLACES, w.points("a.obj"))


def counts(w):
    for title, body in [("a longer vertex", ROWS.replace("1 1 1", "1 1 1 7")), ("a shorter vertex", ROWS.replace("1 1 1", "1 1")),
                        ("a longer face", ROWS.replace("3 0 1 2", "3 0 1 2 2")), ("a shorter face", ROWS.replace("3 0 1 2", "3 0 1")),
                        ("a row too few", "0 0 0\n1 0 0\n3 0 1 2\n"), ("a row too many", ROWS + "3 0 1 2\n"),
                        ("a vertex too many", "5 5 5\n" + ROWS)]:
        w.demand(f"A4: PLY text with {title} is refused")
        w.write("a.ply", ply(body))
        w.expect_refused(w.points("a.ply"), "a.ply", "line ")
    for title, body in [("a row too few", "0 0 0\n1 0 0\n3 0 1 2\n"), ("a row too many", ROWS + "3 0 1 2\n"),
                        ("a short face", ROWS.replace("3 0", "4 0")), ("words behind", ROWS + "bye\n")]:
        w.demand(f"A4: OFF with {title} is refused")
        w.write("a.off", "OFF\n3 1 0\n" + body)
        w.expect_refused(w.points("a.off"), "a.off")
    data = struct.pack("<9f", 0, 0, 0, 1, 1, 1, 0, 1, 0) + struct.pack("<B3i", 3, 0, 1, 2)
    little = {"kind": "binary_little_endian"}
    w.demand("A4: bytes behind binary data are told, missing ones are an error")
    w.write("a.ply", ply(data + b"x" * 12, **little))
    expect_note(w, "a.ply", "12 bytes")
    w.write("a.ply", ply(data[:-1], **little))
    w.expect_refused(w.points("a.ply"), "a.ply")
    w.write("a.stl", binary_stl(behind=b"\0\1"))
    expect_note(w, "a.stl", "2 bytes")
    w.write("a.stl", binary_stl(announced=2))
    w.expect_refused(w.points("a.stl"), "a.stl", "2 triangles")
    w.write("a.obj", texts()["a.obj"])
    w.write("a.pc2", cache(3, [[0, 0, 0, 1, 0, 0, 0, 1, 0]] * 2) + b"abc")
    expect_note(w, "a.pc2", "3 bytes")
    w.write("a.pc2", cache(3, [[0, 0, 0, 1, 0, 0, 0, 1, 0]] * 2)[:-4])
    w.expect_refused(w.points("a.pc2"), "a.pc2")
    w.demand("A4: binary PLY behind a header of any line ends")
    for end in ("\n\r", "\r", "\r\n"):
        w.write("a.ply", ply(data, end=end, **little))
        w.expect(PLACES, w.points("a.ply"))
    w.demand("A4: faces of 0 corners are named")
    for name, content in [("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf\nf 1 2 3\n"), ("a.off", "OFF\n3 1 0\n" + ROWS.replace("3 0 1 2", "0")),
                          ("a.ply", ply(ROWS.replace("3 0 1 2", "0"))), ("a.ply", ply(data[:36] + b"\0", **little))]:
        w.write(name, content)
        w.expect_refused(w.points(name), name, "no vertices|without vertices")
    w.demand("A4: element face 0 without property")
    w.write("a.ply", ply("1 2 3\n", count=1, face="element face 0\n"))
    w.expect([(1, 2, 3)], w.points("a.ply"))
    w.write("a.ply", ply(struct.pack("<3f", 1, 2, 3), count=1, face="element face 0\n", **little))
    w.expect([(1, 2, 3)], w.points("a.ply"))
    for kind in ["int64", "uint64", "long", "half", "complex", "bool"]:
        w.demand(f"A4: a property of type {kind} in PLY text")
        w.write("a.ply", ply("1 2 3 4\n", vertex=XYZ + f"property {kind} id\n", count=1, face=""))
        w.expect([(1, 2, 3)], w.points("a.ply"))
    w.demand("A4: a property of binary PLY that cannot be skipped is named")
    w.write("a.ply", ply(b"\0" * 20, vertex=XYZ + "property half id\n", count=1, face="", **little))
    w.expect_refused(w.points("a.ply"), "id", "half", "export")


def precision(w):
    w.demand("A5: coordinates that binary32 does not hold are told with the largest rounding, and count")
    for t in range(3):
        vertices, faces = grid(8, unit=0.1111)
        w.write(f"f_{t}.obj", "".join(f"v {x - 2487002.881739:.6f} {y - 4684683.676571:.6f} {3529638.983539 + 0.01 * t:.6f}\n"
                                      for x, y, _ in vertices) + faces)
    done = w.expect_run(["encode", ".", "-o", "o.reeb"], 0, "float32", r"0\.2[0-9]*", "subtract")
    w.expect("an error that is not 0", done.err, "maximum 0 " not in done.err)
    w.expect_run(["encode", ".", "-o", "p.reeb", "--max-error", "0.01"], 1, "0.01")
    done = w.expect_run(["encode", ".", "-o", "q.reeb", "--lossless"], 0)
    w.expect("no claim of every bit", done.err, not done.says("kept to the bit\n"))
    compared = w.expect_run(["compare", ".", "q.reeb"], 0).out.decode()
    w.expect("an error of 0.2", compared, "0.2" in compared)
    doubles = [(2487003 + 0.01 * i, 4684683.5, 1) for i in range(3)]
    for kind, body in [("ascii", "".join("%.2f %.2f %.2f\n" % xyz for xyz in doubles) + "3 0 1 2\n"),
                       ("binary_big_endian", b"".join(struct.pack(">3d", *xyz) for xyz in doubles) + struct.pack(">B3i", 3, 0, 1, 2))]:
        w.demand(f"A5: PLY of doubles, {kind}")
        w.write("a.ply", ply(body, vertex=XYZ.replace("float", "double"), kind=kind))
        done = w.expect_run(["encode", "a.ply", "-o", "o.reeb", "-f", "--lossless"], 0, "float32")
        w.expect("no claim of every bit", done.err, not done.says("kept to the bit\n"))
    w.demand("A5: twenty digits of a binary32 value are no rounding")
    w.write("a.obj", "v 0.100000001490116119385 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    expect_note(w, "a.obj", "every position is kept to the bit")


def kept(w):
    for title, text, word in [("lines", "l 1 2\n", "lines"), ("points", "p 1\n", "points"), ("statements nobody knows", "zebra 1\n", "zebra"),
                              ("free-form elements", "cstype bezier\ndeg 2\ncurv 0 1 1 2 3\nend\n", "curves"),
                              ("a material file", "mtllib a.mtl\nusemtl red\n", "mtl")]:
        w.demand(f"A6: {title} of OBJ are told")
        w.write("a.obj", texts()["a.obj"].replace("f ", text + "f "))
        expect_note(w, "a.obj", word)
    colours = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"
    w.demand("A6: colours come back, or it is told")
    w.write("a.obj", colours)
    expect_note(w, "a.obj")
    w.expect_run(["decode", "o.reeb", "-o", "b.obj"], 0)
    w.expect(colours.encode(), w.read("b.obj"))
    w.expect_run(["decode", "o.reeb", "-o", "b.stl"], 0, "color")
    w.demand("A6: elements of PLY are told")
    w.write("a.ply", ply(ROWS + "0 1\n", face=LIST + "element edge 1\nproperty int vertex1\nproperty int vertex2\n"))
    expect_note(w, "a.ply", "edge")
    w.demand("A6: attribute bytes of STL are told")
    w.write("a.stl", binary_stl(attribute=0x7fff))
    expect_note(w, "a.stl", "attribute")


def spellings(w):
    body = STL.split("\n", 1)[1]
    for title, content in [
            ("upper case", STL.upper()), ("Solid", STL.replace("solid", "Solid")), ("end loop", STL.replace("endloop", "end loop")),
            ("end facet, end solid", STL.replace("endfacet", "end facet").replace("endsolid", "end solid")), ("blanks before", "  " + STL),
            ("blank lines before", "\n\n" + STL), ("blank lines within", STL.replace("\n", "\n\n")), ("no name", STL.replace(" a b", "")),
            ("CR", STL.replace("\n", "\r")), ("a mark", "\ufeff" + STL), ("no normal", STL.replace(" normal 0 0 1", "")),
            ("a normal of nan", STL.replace("0 0 1\n", "nan nan nan\n", 1)), ("one line", "solid a\n" + " ".join(body.split("\n")) + "\n"),
            ("blank lines behind", STL + "  \n\n \n"), ("zeros behind", STL + "\0\0"), ("Ctrl-Z behind", STL + "\x1a"),
            ("mixed case", STL.replace("vertex", "Vertex").replace("outer", "OUTER")), ("binary that begins with solid", binary_stl())]:
        w.demand(f"B: STL, {title}")
        w.write("a.stl", content)
        w.expect(PLACES, w.points("a.stl"))
    for title, text in [
            ("glued counts", "OFF3 1 0\n" + ROWS), ("counts behind the keyword", "OFF 3 1 0\n" + ROWS), ("no keyword", "3 1 0\n" + ROWS),
            ("counts over lines", "OFF\n3\n1\n0\n" + ROWS), ("several vertices a line", "OFF\n3 1 0\n0 0 0 1 1 1 0 1 0\n3 0 1 2\n"),
            ("all in one line", "OFF 3 1 0 " + ROWS.replace("\n", " ")), ("CR", ("OFF\n3 1 0\n" + ROWS).replace("\n", "\r")),
            ("a vertex over lines", "OFF\n3 1 0\n0\n0\n0\n1 1\n1\n0 1 0\n3\n0 1 2\n"), ("two counts", "OFF\n3 1\n" + ROWS),
            ("comments", "# a\nOFF # b\n\n3 1 0 # c\n# d\n" + ROWS), ("lower case", "off\n3 1 0\n" + ROWS), ("edges", "OFF\n3 1 3\n" + ROWS),
            ("a mark and CR LF", ("\ufeffOFF\n3 1 0\n" + ROWS).replace("\n", "\r\n")),
            ("face colours", "OFF\n3 1 0\n" + ROWS.replace("3 0 1 2", "3 0 1 2 255 0 0"))]:
        w.demand(f"B: OFF, {title}")
        w.write("a.off", text)
        w.expect(PLACES, w.points("a.off"))


def extensions(w):
    for name in ["A.OBJ", "a.Obj", "A.PLY", "A.OFF", "a.StL"]:
        w.demand(f"B: extension in any case: {name}")
        w.write(name, texts()["a." + name[2:].lower()])
        w.expect(PLACES, w.points(name))
        w.expect(PLACES, w.points("."))
    w.demand("B: extension in any case, in every command and beside a cache")
    w.write("a.Obj", texts()["a.obj"])
    w.write("a.PC2", cache(3, [[0, 0, 0, 1, 0, 0, 0, 1, 0]] * 2))
    for command in (["encode", "a.PC2", "-o", "W.REEB"], ["info", "W.REEB"], ["verify", "W.REEB"],
                    ["decode", "W.REEB", "-o", "B.OBJ", "--frames", "1"], ["decode", "W.REEB", "-o", "C.Mdd", "--fps", "24"],
                    ["compare", "a.PC2", "W.REEB"], ["encode", "W.REEB", "-o", "X.ReeB"], ["picture", "W.REEB", "-o", "P.PNG"]):
        w.expect_run(command, 0)


def empty_frames(w):
    empty = {"obj": "# nothing\n", "ply": ply("", count=0, face=""), "off": "OFF\n0 0 0\n", "stl": "solid a\nendsolid a\n"}
    for kind, content in empty.items():
        for place in range(3):
            w.demand(f"B: frame {place + 1} of 3 {kind.upper()} files is empty: kept, or a remedy that fits")
            for t in range(3):
                w.write(f"f_{t}.{kind}", content if t == place else texts()["a." + kind])
            done = w.run("encode", ".", "-o", "o.reeb")
            fits = done.says(f"f_{place}.{kind}", "leave") and not done.says("export the frame again")
            w.expect("0, or leave it out", (done.code, done.err), done.code == 0 or fits)


STEPS = [order, odd_names, numbers, lines, counts, precision, kept, spellings, extensions, empty_frames]
