"""Streams taken apart into chunks and fields, and put together again."""
import struct

UINT32 = (1 << 32) - 1
SIGNATURE = b"\x89REEB\r\n\x01"


def crc32c(data):
    crc = UINT32
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ UINT32


def uv(value):
    out = b""
    while value > 127:
        out += bytes([value & 127 | 128])
        value >>= 7
    return out + bytes([value])


def f64(value):
    raw = struct.pack(">d", value).rstrip(b"\0")
    return bytes([len(raw)]) + raw


LENGTHS = (("draco", "draco_bytes"), ("rest", "rest_bytes"), ("position", "position_bytes"),
           ("order", "order_bytes"), ("motion", "motion_bytes"),
           ("coefficients", "coefficient_bytes"), ("basis", "basis_bytes"), ("corrections", "correction_bytes"),
           ("differences", "difference_bytes"), ("raw", "raw_bytes"))


class Fields:
    """Reads fields of bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        self.at += count
        return self.data[self.at - count:self.at]

    def uv(self):
        value = shift = 0
        while True:
            byte = self.take(1)[0]
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    def f64(self):
        return self.take(1 + self.data[self.at])


class Header(dict):
    """Named fields, packed in the order they were put in. A field of bytes stands for itself."""

    def pack(self):
        return b"".join(value if isinstance(value, bytes) else uv(value) for value in self.values())

    def but(self, **changes):
        return Header({**self, **changes})


def read_head(payload):
    f = Fields(payload)
    return Header(total_frames=f.uv(), shot_count=f.uv(), rates=f.data[f.at:-1], flags=f.data[-1:])


def read_reference(payload):
    """Fields of REFM and of its mesh."""
    f = Fields(payload)
    h = Header(shot=f.uv(), first_frame=f.uv(), origin=f.take(12), grid_step=f.take(4), flags=f.take(1),
               vertex_count=f.uv(), face_count=f.uv(), mesh_flags=f.take(1), draco_bytes=f.uv(), rest_bytes=f.uv())
    if h["mesh_flags"][0] & 4:
        h["position_bytes"] = f.uv()
    h["order_bytes"] = f.uv()
    for section, length in LENGTHS:
        if length in h:
            h[section] = f.take(h[length])
    return h


def read_group(payload):
    f = Fields(payload)
    h = Header(first_frame=f.uv(), frame_count=f.uv(), shot=f.uv(), profile=f.take(1))
    if h["profile"] == b"\3":
        h.update(stored_count=f.uv(), flags=f.take(1), difference_bytes=f.uv(), raw_bytes=f.uv())
        return h.but(differences=f.take(h["difference_bytes"]), raw=f.take(h["raw_bytes"]))
    h.update(component_count=f.uv(), quantization_step=f.take(4))
    if h["profile"] == b"\2":
        h["axis_steps"] = f.take(12)
    h.update(region_count=f.uv(), flags=f.take(1), motion_bytes=f.uv(), coefficient_bytes=f.uv(), basis_bytes=f.uv())
    if h["flags"][0] & 2:
        h["correction_step"] = f.f64()
        h.update(correction_count=f.uv(), correction_bytes=f.uv())
    for section, length in LENGTHS:
        if length in h:
            h[section] = f.take(h[length])
    return h


READERS = {b"HEAD": read_head, b"REFM": read_reference, b"GRUP": read_group}


class File:
    """A stream as a list of (type, payload)."""

    def __init__(self, data):
        self.chunks = []
        f = Fields(data)
        f.take(8)
        kind = b""
        while kind != b"seek":
            kind = f.take(4)
            self.chunks.append((kind, f.take(f.uv())))
            f.take(4)
        self.chunks.pop()

    def places(self, kind):
        return [i for i, chunk in enumerate(self.chunks) if chunk[0] == kind]

    def edited(self, kind, which=0, **changes):
        """With fields of a chunk changed; lengths follow sections that are."""
        i = self.places(kind)[which]
        h = READERS[kind](self.chunks[i][1])
        for section, length in LENGTHS:
            if section in changes and length not in changes:
                changes[length] = len(changes[section])
        return self.replaced(i, kind, h.but(**changes).pack())

    def replaced(self, i, kind, payload):
        out = File.__new__(File)
        out.chunks = list(self.chunks)
        out.chunks[i] = (kind, payload)
        return out

    def inserted(self, i, kind, payload):
        out = File.__new__(File)
        out.chunks = self.chunks[:i] + [(kind, payload)] + self.chunks[i:]
        return out

    def without(self, i):
        out = File.__new__(File)
        out.chunks = self.chunks[:i] + self.chunks[i + 1:]
        return out

    def only(self, *kinds):
        """The first chunk of each of these types."""
        out = File.__new__(File)
        out.chunks = [self.chunks[self.places(kind)[0]] for kind in kinds]
        return out

    def offsets(self):
        """Where each chunk starts, and where `seek` does."""
        at = [8]
        for kind, payload in self.chunks:
            at.append(at[-1] + len(pack_chunk(kind, payload)))
        return at

    def pack(self, seek=None):
        out = SIGNATURE + b"".join(pack_chunk(kind, payload) for kind, payload in self.chunks)
        table = pack_chunk(b"seek", self.seek_table() if seek is None else seek)
        return out + table + struct.pack("<I", len(table) + 8) + b"reeb"

    def seek_table(self):
        entries = b""
        count = 0
        end = 0
        for at, (kind, payload) in zip(self.offsets(), self.chunks):
            if kind in (b"REFM", b"GRUP"):
                size = len(pack_chunk(kind, payload))
                frames = read_group(payload)["frame_count"] if kind == b"GRUP" else 0
                entries += uv(at - end) + uv(size) + uv(frames)
                count += 1
                end = at + size
        return uv(count) + entries


def pack_chunk(kind, payload):
    return kind + uv(len(payload)) + payload + struct.pack("<I", crc32c(kind + payload))


def flipped(data, at):
    return data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1:]


def with_bits(data, first, count, value):
    """`value` in the bits first .. first + count - 1, the lowest bit of a byte first."""
    mask = (1 << count) - 1
    bits = int.from_bytes(data, "little") & ~(mask << first) | (value & mask) << first
    return bits.to_bytes(len(data), "little")


def work(data):
    """Vertices times planes of a sound stream, about what decoding it costs; 0 of others."""
    try:
        file = File(data)
    except (IndexError, ValueError):
        return 0
    total = 0
    vertices = 0
    for kind, payload in file.chunks:
        try:
            if kind == b"REFM":
                vertices = read_reference(payload)["vertex_count"]
                total += 5 * vertices + vertices * vertices // 500
            elif kind == b"GRUP":
                h = read_group(payload)
                planes = h["component_count"] if "component_count" in h else 3 * h["stored_count"]
                total += vertices * planes + 3 * h["frame_count"] * (planes + 1)
        except IndexError:
            return 0
    return total
