"""Meshes of a glTF file (.glb, or .gltf with its buffers inside) as OBJ text: positions, texture coordinates, colours.

Vertices that agree in all of these are one: exporters write a vertex for every corner. Compressed accessors (extensions)
are not read. For measuring only; `reeb encode` reads glTF by itself where it can.
"""
import base64
import json
import pathlib
import struct

COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
LARGEST = {5121: 255, 5123: 65535}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def load(path):
    """(JSON, bytes of buffer 0)."""
    raw = pathlib.Path(path).read_bytes()
    if raw[:4] != b"glTF":
        document = json.loads(raw)
        return document, base64.b64decode(document["buffers"][0]["uri"].split(",", 1)[1])
    length = struct.unpack_from("<I", raw, 12)[0]
    return json.loads(raw[20:20 + length]), raw[28 + length:]


def accessor(document, buffer, index):
    """Tuples of numbers, normalised ones as fractions."""
    a = document["accessors"][index]
    view = document["bufferViews"][a["bufferView"]]
    if view.get("extensions"):
        raise ValueError("a compressed buffer view")
    form = "<%d%s" % (WIDTHS[a["type"]], COMPONENTS[a["componentType"]])
    stride = view.get("byteStride", struct.calcsize(form))
    start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
    rows = [struct.unpack_from(form, buffer, start + i * stride) for i in range(a["count"])]
    scale = LARGEST.get(a["componentType"]) if a.get("normalized") else None
    return [tuple(x / scale for x in row) for row in rows] if scale else rows


class Table:
    """Different rows, numbered from 1."""

    def __init__(self):
        self.rows = {}

    def number(self, row):
        return self.rows.setdefault(row, len(self.rows) + 1)


def to_obj(path):
    document, buffer = load(path)
    vertices, texture, faces = Table(), Table(), []
    for mesh in document["meshes"]:
        for n, primitive in enumerate(mesh["primitives"]):
            names = primitive["attributes"]
            rows = accessor(document, buffer, names["POSITION"])
            if "COLOR_0" in names:
                rows = [p + c[:3] for p, c in zip(rows, accessor(document, buffer, names["COLOR_0"]))]
            uv = accessor(document, buffer, names["TEXCOORD_0"]) if "TEXCOORD_0" in names else None
            order = range(len(rows))
            if "indices" in primitive:
                order = [row[0] for row in accessor(document, buffer, primitive["indices"])]
            corners = ["%d" % vertices.number(rows[i]) + ("/%d" % texture.number(uv[i]) if uv else "") for i in order]
            faces.append("usemtl m%s" % primitive.get("material", n))
            faces += ["f " + " ".join(corners[i:i + 3]) for i in range(0, len(corners) - 2, 3)]
    lines = ["v " + " ".join("%.9g" % x for x in row) for row in vertices.rows]
    lines += ["vt %.9g %.9g" % row for row in texture.rows]
    return "\n".join(lines + faces) + "\n"
