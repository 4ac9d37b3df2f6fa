"""attributes.md sections 2, 3, 10, 12 and 13: chunks of what a mesh carries beside positions."""
import math
import struct
from dataclasses import dataclass, field

from .arithmetic import clamp, f32
from .bytes import LARGEST_F32, Reader
from .errors import Corrupt, Truncated, require

UINT32 = (1 << 32) - 1
BINARY32, U8, U16, I32, U8_NORMALISED, U16_NORMALISED = range(6)
VERTEX, CORNER, FACE, SHOT = range(4)
TEXTURE_COORDINATE, NORMAL, MATERIAL, GROUP, INDEX = 1, 2, 6, 7, 8
ANIMATED, COMPUTED, CORRECTED, TURNING = 1, 2, 4, 8
MULTIPLES, BITS = 0, 1
FORMATS = {BINARY32: "<I", U8: "<B", U16: "<H", I32: "<i", U8_NORMALISED: "<B", U16_NORMALISED: "<H"}
RANGES = {U8: (0, 255), U16: (0, 65535), I32: (-2 ** 31, 2 ** 31 - 1), U8_NORMALISED: (0, 255),
          U16_NORMALISED: (0, 65535)}


@dataclass
class Channel:
    """Section 3."""
    numbers: int
    low: int
    step: float
    top: int

    def check(self, kind):
        high = self.low + self.top
        if self.numbers == BITS:
            fits = kind == BINARY32 and self.low >= 0 and high <= UINT32
        elif kind == BINARY32:
            fits = max(abs(self.low), abs(high)) * self.step <= LARGEST_F32
        else:
            fits = 1 <= self.step <= 65536 and self.step == math.floor(self.step)
        require(fits, "attr: the numbers of a channel do not fit its type")

    def number(self, kind, n):
        """Bits of a binary32, or an integer."""
        if self.numbers == BITS:
            ordered = self.low + n
            return ordered - (1 << 31) if ordered >> 31 else UINT32 - ordered
        if kind == BINARY32:
            return struct.unpack("<I", struct.pack("<f", f32(float(self.low + n) * self.step)))[0]
        return clamp((self.low + n) * int(self.step), *RANGES[kind])


@dataclass
class Attribute:
    """`attr`, section 2."""
    shot: int
    index: int
    name: str
    semantic: int
    domain: int
    kind: int
    channel_count: int
    flags: int
    body: bytes = b""
    names: list = field(default_factory=list)
    channels: list = field(default_factory=list)

    def animated(self):
        return self.flags & ANIMATED != 0

    def computed(self):
        return self.flags & COMPUTED != 0

    def corrected(self):
        return self.flags & CORRECTED != 0

    def in_groups(self):
        return self.flags & (TURNING if self.computed() else ANIMATED) != 0

    def coded_channels(self):
        """Section 11: of computed normals, those of the corrections."""
        if not self.computed():
            return self.channel_count
        return 2 if self.corrected() else 0

    def may_be_computed(self):
        return (self.semantic == NORMAL and self.kind == BINARY32 and self.channel_count == 3 and
                self.domain in (VERTEX, CORNER))

    def categorical(self):
        of_faces = self.domain == FACE and self.semantic in (MATERIAL, GROUP)
        of_corners = self.domain == CORNER and self.semantic == INDEX
        return ((of_faces or of_corners) and self.channel_count == 1 and
                self.kind != BINARY32 and self.channels[0].top <= 1 << 30)


def read_attribute(payload):
    reader = Reader(payload)
    shot = reader.uv("shot", 0, UINT32)
    index = reader.uv("index", 0, 255)
    name = reader.text("name")
    require(len(name.encode()) <= 256, "attr: a long name")
    semantic = reader.u8("semantic", 0, 8)
    domain = reader.u8("domain", 0, 3)
    kind = reader.u8("type", 0, 5)
    channel_count = reader.u8("channel_count", 1, 16)
    flags = reader.flags("flags", ANIMATED | COMPUTED | CORRECTED | TURNING)
    out = Attribute(shot, index, name, semantic, domain, kind, channel_count, flags, reader.take(reader.remaining()))
    require(not out.computed() or out.animated() and out.may_be_computed(), "attr: nothing that can be computed")
    require(not out.corrected() or out.computed(), "attr: corrections of nothing")
    require(not flags & TURNING or out.corrected(), "attr: no corrections that differ")
    return out


def read_body(attribute):
    """Fills names and channels; the section."""
    reader = Reader(attribute.body)
    try:
        attribute.names = [reader.text("name") for _ in range(reader.uv("name_count"))]
        attribute.channels = [read_channel(reader) for _ in range(reader.uv("channel_headers"))]
    except Truncated as fault:
        raise Corrupt(str(fault))
    wanted = 0 if attribute.in_groups() else attribute.coded_channels()
    require(len(attribute.channels) == wanted, "attr: not a header for every channel")
    for channel in attribute.channels:
        channel.check(attribute.kind)
        require(not attribute.computed() or channel.numbers == MULTIPLES, "attr: corrections that are no multiples")
    return reader.take(reader.remaining())


def read_channel(reader):
    numbers = reader.u8("numbers", 0, 1)
    folded = reader.uv("low_folded", 0, 1 << 41)
    low = -(folded >> 1) - 1 if folded & 1 else folded >> 1
    return Channel(numbers, low, reader.f64("step", 2.0 ** -1022, LARGEST_F32), reader.uv("top", 0, UINT32))


@dataclass
class AttributeGroup:
    """`agrp`, section 10."""
    shot: int
    index: int
    first_frame: int
    frame_count: int
    sections: bytes


def read_attribute_group(payload):
    reader = Reader(payload)
    shot = reader.uv("shot", 0, UINT32)
    index = reader.uv("index", 0, 255)
    first_frame = reader.uv("first_frame", 0, UINT32)
    frame_count = reader.uv("frame_count", 1, 65536)
    return AttributeGroup(shot, index, first_frame, frame_count, reader.take(reader.remaining()))


def read_group_body(part, channel_count):
    """Section 10: scales and payloads."""
    reader = Reader(part.sections)
    try:
        scales = [reader.f64("scale", 2.0 ** -1022, LARGEST_F32) for _ in range(reader.uv("scale_count", 0, 16))]
        sizes = [reader.uv("part_bytes", 0, UINT32) for _ in range(reader.uv("part_count", 0, 6))]
        payloads = [reader.take(size) for size in sizes]
    except Truncated as fault:
        raise Corrupt(str(fault))
    require(len(scales) == channel_count and len(sizes) == (channel_count + 2) // 3, "agrp: not a scale for every channel")
    require(reader.remaining() == 0, "agrp: parts do not fill the chunk")
    return scales, payloads


def read_resource(payload):
    """Section 12: (name, media type, bytes)."""
    reader = Reader(payload)
    name, media_type = reader.text("name"), reader.text("media_type")
    require(len(name.encode()) <= 256 and len(media_type.encode()) <= 128, "rsrc: a long name")
    return name, media_type, reader.take(reader.remaining())


def read_bounds(payload):
    """Section 13: (low, high) of each group."""
    reader = Reader(payload)
    boxes = []
    for _ in range(reader.uv("group_count", 0, reader.remaining() // 24)):
        low, high = ([reader.f32("bound", -LARGEST_F32, LARGEST_F32) for _ in range(3)] for _ in range(2))
        require(all(a <= b for a, b in zip(low, high)), "bnds: a box is inside out")
        boxes.append((low, high))
    require(reader.remaining() == 0, "bnds: bytes after the last field")
    return boxes
