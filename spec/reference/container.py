"""container.md: chunks, headers, seek table, damage."""
import struct
from dataclasses import dataclass, field

from .attribute_chunks import read_attribute, read_attribute_group, read_bounds, read_resource
from .bytes import LARGEST_F32, LEAST_F32, Reader
from .errors import Corrupt, LimitExceeded, Truncated, Unsupported, require

SIGNATURE = b"\x89REEB\r\n"
UINT32 = (1 << 32) - 1
MAIN, FAST, THESIS, LOSSLESS = 0, 1, 2, 3
CONTINUES, CORRECTED, QUICK, WEAK_PRIOR = 1, 2, 4, 8  # bits of a group's flags
OPEN_ENDED = 1  # bit of the sequence header's flags
ORDER_KEPT, FACE_ORDER_KEPT, PLAIN = 1, 2, 4  # bits of a mesh's flags

# README.md section 5: what this decoder allows.
MAX_FRAMES = 1 << 20
MAX_VERTICES = 1 << 24
MAX_FACES = 1 << 25


def make_crc_table():
    table = []
    for i in range(256):
        for _ in range(8):
            i = (i >> 1) ^ (0x82F63B78 if i & 1 else 0)
        table.append(i)
    return table


CRC_TABLE = make_crc_table()


def crc32c(data):
    crc = UINT32
    for byte in data:
        crc = CRC_TABLE[(crc ^ byte) & 255] ^ (crc >> 8)
    return crc ^ UINT32


@dataclass
class Chunk:
    type: bytes
    offset: int
    size: int
    payload: bytes
    intact: bool


class NoChunk(Exception):
    """No chunk can start here, section 4."""


def read_chunk(data, offset):
    """Section 3. Truncated where the file ends inside the chunk."""
    reader = Reader(data, offset)
    kind = reader.take(4)
    if not kind.isalpha():
        raise NoChunk
    try:
        length = reader.uv()
    except Corrupt:
        raise NoChunk
    payload = reader.take(length)
    crc = reader.u32()
    return Chunk(kind, offset, reader.position - offset, payload, crc32c(kind + payload) == crc)


@dataclass
class Reference:
    """`REFM`, section 3.2."""
    shot: int
    first_frame: int
    origin: tuple
    grid_step: float
    mesh: bytes  # the coded mesh


@dataclass
class Group:
    """`GRUP`, section 3.3."""
    first_frame: int
    frame_count: int
    shot: int
    profile: int
    flags: int = 0
    component_count: int = 0
    quantization_step: float = 1.0
    axis_step: tuple = (1.0, 1.0, 1.0)
    region_count: int = 0
    stored_count: int = 0
    motion: bytes = b""
    coefficients: bytes = b""
    basis: bytes = b""
    correction_step: float = 1.0
    correction_count: int = 0
    corrections: bytes = b""
    differences: bytes = b""
    raw: bytes = b""

    def section_bytes(self):
        sections = (self.motion, self.coefficients, self.basis, self.corrections, self.differences, self.raw)
        return sum(len(section) for section in sections)


@dataclass
class File:
    """What a file holds."""
    total_frames: int = 0
    shot_count: int = 0
    open_ended: bool = False
    references: dict = field(default_factory=dict)  # by shot
    groups: list = field(default_factory=list)  # in order of frames
    metadata: list = field(default_factory=list)
    attributes: list = field(default_factory=list)  # rising by shot and index
    attribute_groups: list = field(default_factory=list)  # rising by first frame and index
    bounds: list = None
    truncated: bool = False
    damaged: bool = False

    def sound(self):
        return not self.truncated and not self.damaged

    def frames_end(self):
        return self.groups[-1].first_frame + self.groups[-1].frame_count if self.groups else 0


def read_head(payload, file):
    """Section 3.1."""
    reader = Reader(payload)
    file.total_frames = reader.uv("total_frames", 1, UINT32)
    file.shot_count = reader.uv("shot_count", 1, file.total_frames)
    reader.f64("frame_rate", 0, 1e9)
    reader.f64("start_time", -1e15, 1e15)
    file.open_ended = reader.flags("flags", OPEN_ENDED) != 0
    require(reader.remaining() == 0, "HEAD: bytes after the last field")
    if not file.open_ended and file.total_frames > MAX_FRAMES:
        raise LimitExceeded("too many frames")


def read_reference(payload):
    """Section 3.2."""
    reader = Reader(payload)
    shot = reader.uv("shot", 0, UINT32)
    first_frame = reader.uv("first_frame", 0, UINT32)
    origin = tuple(reader.f32("origin", -LARGEST_F32, LARGEST_F32) for _ in range(3))
    grid_step = reader.f32("grid_step", 0, LARGEST_F32)
    reader.flags("flags", 0)
    return Reference(shot, first_frame, origin, grid_step, reader.take(reader.remaining()))


def read_group(payload):
    """Section 3.3."""
    reader = Reader(payload)
    first_frame = reader.uv("first_frame", 0, UINT32)
    frame_count = reader.uv("frame_count", 1, 65536)
    shot = reader.uv("shot", 0, UINT32)
    profile = reader.u8("profile", 0, 3)
    group = Group(first_frame, frame_count, shot, profile)
    if profile == LOSSLESS:
        read_lossless(reader, group)
    else:
        read_components(reader, group)
    require(reader.remaining() == 0, "GRUP: sections do not fill the chunk")
    return group


def read_lossless(reader, group):
    group.stored_count = reader.uv("stored_count", 0, 3 * 65536)
    group.flags = reader.flags("flags", QUICK)
    difference_bytes = reader.uv("difference_bytes", 0, UINT32)
    raw_bytes = reader.uv("raw_bytes", 0, UINT32)
    group.differences = reader.take(difference_bytes)
    group.raw = reader.take(raw_bytes)


def read_components(reader, group):
    group.component_count = reader.uv("component_count", 0, 3 * 65536)
    group.quantization_step = reader.f32("quantization_step", LEAST_F32, LARGEST_F32)
    if group.profile == THESIS:
        group.axis_step = tuple(reader.f32("axis_step", LEAST_F32, LARGEST_F32) for _ in range(3))
    group.region_count = reader.uv("region_count", 0, UINT32)
    group.flags = reader.flags("flags", CONTINUES | CORRECTED | WEAK_PRIOR)
    motion_bytes = reader.uv("motion_bytes", 0, UINT32)
    coefficient_bytes = reader.uv("coefficient_bytes", 0, UINT32)
    basis_bytes = reader.uv("basis_bytes", 0, UINT32)
    correction_bytes = 0
    if group.flags & CORRECTED:
        group.correction_step = reader.f64("correction_step", 2.0 ** -1022, LARGEST_F32)
        group.correction_count = reader.uv("correction_count", 0, 3 * (1 << 25) * 65536)
        correction_bytes = reader.uv("correction_bytes", 0, UINT32)
    group.motion = reader.take(motion_bytes)
    group.coefficients = reader.take(coefficient_bytes)
    group.basis = reader.take(basis_bytes)
    group.corrections = reader.take(correction_bytes)


def read_metadata(payload):
    """Section 3.4."""
    reader = Reader(payload)
    count = reader.uv("entry_count")
    entries = []
    for _ in range(count):
        entries.append((reader.text("key"), reader.text("value")))
    require(reader.remaining() == 0, "meta: bytes after the last field")
    return entries


def read_seek_table(payload):
    """Section 3.5: (gap, size, frame_count) of each entry."""
    reader = Reader(payload)
    count = reader.uv("entry_count")
    entries = []
    for _ in range(count):
        entries.append((reader.uv("gap", 0, 1 << 62), reader.uv("size", 9, 1 << 62), reader.uv("frame_count", 0, 65536)))
    require(reader.remaining() == 0, "seek: bytes after the last field")
    return entries


def find_seek_chunk(data):
    """The seek table that the trailer leads to (section 2), or None."""
    if len(data) < 16 or data[-4:] != b"reeb":
        return None
    distance = struct.unpack("<I", data[-8:-4])[0]
    if not 8 <= distance <= len(data) - 8:
        return None
    try:
        chunk = read_chunk(data, len(data) - distance)
    except (NoChunk, Truncated):
        return None
    whole = chunk.intact and chunk.type == b"seek" and chunk.size + 8 == distance
    return chunk if whole else None


def find_landmarks(data):
    """Section 4: where chunks start, as the seek table knows it."""
    chunk = find_seek_chunk(data)
    if chunk is None:
        return []
    try:
        entries = read_seek_table(chunk.payload)
    except (Corrupt, Truncated):
        return []
    at = 0
    starts = []
    for gap, size, _ in entries:
        if gap > chunk.offset - at:
            break
        at += gap
        starts.append(at)
        if size > chunk.offset - at:
            break
        at += size
    return starts + [chunk.offset]


class FileReader:
    """Section 2, chunk after chunk."""

    def __init__(self, data):
        self.data = data
        self.file = File()
        self.entries = []  # what the seek table must say
        self.entries_end = 0
        self.table_seen = False

    def read(self):
        data = self.data
        require(data[:7] == SIGNATURE[:len(data)], "not a Reeb file")
        if len(data) < 8:
            raise Truncated("the file ends in its signature")
        if data[7] != 1:
            raise Unsupported("format version %d" % data[7])
        offset = 8
        try:
            head = read_chunk(data, offset)
        except NoChunk:
            raise Corrupt("the first chunk is not HEAD")
        require(head.type == b"HEAD" and head.intact, "the first chunk is not a sound HEAD")
        with_end_as_fault(read_head, head.payload, self.file)
        self.read_chunks(offset + head.size)
        self.check_counts()
        return self.file

    def check_counts(self):
        file = self.file
        if file.open_ended:
            file.total_frames = file.frames_end()
            require(not file.sound() or file.groups and max(r.first_frame for r in file.references.values()) <
                    file.total_frames, "the file ends with a shot without frames")
        elif file.sound():
            require(file.bounds is None or len(file.bounds) == len(file.groups), "bnds: not a box for each group")
            require(len(file.references) == file.shot_count and file.frames_end() == file.total_frames,
                    "HEAD announces more than the file holds")

    def read_chunks(self, offset):
        landmarks = find_landmarks(self.data)
        while not self.at_end(offset):
            try:
                chunk = read_chunk(self.data, offset)
                end = offset + chunk.size
                if chunk.intact:
                    with_end_as_fault(self.take, chunk)
                    offset = end
                    continue
            except NoChunk:
                end = len(self.data)
            except Truncated:
                end = None
            self.file.damaged = True
            following = min((at for at in landmarks if at > offset), default=end)
            ancillary = end is not None and self.data[offset:offset + 1].islower()
            offset = min(following, end) if ancillary else following
            if offset is None:
                self.file.truncated = True
                return

    def at_end(self, offset):
        rest = self.data[offset:]
        if len(rest) == 8 and rest[-4:] == b"reeb":
            if not self.table_seen or find_seek_chunk(self.data) is None:
                self.file.damaged = True
            return True
        if self.table_seen and len(rest) >= 8:
            self.file.damaged = True
            return True
        if rest and not self.table_seen:
            return False
        self.file.truncated = True
        return True

    def take(self, chunk):
        if chunk.type == b"REFM":
            self.take_reference(chunk)
        elif chunk.type == b"GRUP":
            self.take_group(chunk)
        elif chunk.type == b"meta":
            self.file.metadata += read_metadata(chunk.payload)
        elif chunk.type == b"attr":
            self.take_attribute(chunk)
        elif chunk.type == b"agrp":
            self.take_attribute_group(chunk)
        elif chunk.type == b"rsrc":
            read_resource(chunk.payload)
        elif chunk.type == b"bnds":
            require(self.file.bounds is None, "bnds: a second one")
            self.file.bounds = read_bounds(chunk.payload)
        elif chunk.type == b"seek":
            entries = read_seek_table(chunk.payload)
            require(entries == self.entries or not self.file.sound(), "the seek table is wrong")
            self.table_seen = True
        elif chunk.type == b"HEAD":
            raise Corrupt("a second HEAD")
        elif chunk.type[:1].isupper():
            raise Unsupported("unknown critical chunk")

    def take_attribute(self, chunk):
        """attributes.md section 2."""
        file = self.file
        attribute = read_attribute(chunk.payload)
        before = file.attributes[-1] if file.attributes else None
        same_shot = before is not None and before.shot == attribute.shot
        require(before is None or before.shot <= attribute.shot, "attr: shots out of order")
        require(not same_shot or attribute.index > before.index, "attr: attributes out of order")
        if file.sound():
            require(attribute.index == (before.index + 1 if same_shot else 0), "attr: attributes are not consecutive")
            require(attribute.shot == max(file.references, default=-1), "attr: no reference mesh before it")
        file.attributes.append(attribute)

    def take_attribute_group(self, chunk):
        """attributes.md section 10."""
        file = self.file
        part = read_attribute_group(chunk.payload)
        if file.attribute_groups:
            last = file.attribute_groups[-1]
            require((part.first_frame, part.index) > (last.first_frame, last.index), "agrp: out of order")
        owner = [a for a in file.attributes if a.shot == part.shot and a.index == part.index]
        require(owner[0].in_groups() if owner else not file.sound(), "agrp: no animated attribute of this index")
        if file.sound():
            group = file.groups[-1] if file.groups else None
            require(group is not None and (group.shot, group.first_frame, group.frame_count) ==
                    (part.shot, part.first_frame, part.frame_count), "agrp: not the frames of the group before it")
        file.attribute_groups.append(part)

    def note(self, chunk, frame_count):
        self.entries.append((chunk.offset - self.entries_end, chunk.size, frame_count))
        self.entries_end = chunk.offset + chunk.size

    def take_reference(self, chunk):
        file = self.file
        reference = read_reference(chunk.payload)
        header = read_mesh_header(Reader(reference.mesh))
        if header.vertex_count > MAX_VERTICES or header.face_count > MAX_FACES:
            raise LimitExceeded("the mesh is too large")
        shots = list(file.references)
        require(reference.shot < file.shot_count and (not shots or reference.shot > shots[-1]), "REFM: wrong shot")
        require(file.frames_end() <= reference.first_frame < file.total_frames, "REFM: wrong first_frame")
        if file.sound():
            starts = [r.first_frame for r in file.references.values()]
            require(reference.shot == len(shots) and reference.first_frame == file.frames_end() and
                    reference.first_frame not in starts, "REFM: shots are not consecutive")
        file.references[reference.shot] = reference
        self.note(chunk, 0)

    def take_group(self, chunk):
        file = self.file
        group = read_group(chunk.payload)
        if file.open_ended and group.first_frame + group.frame_count > MAX_FRAMES:
            raise LimitExceeded("too many frames")
        require(group.first_frame + group.frame_count <= file.total_frames, "GRUP: past the end of the sequence")
        require(group.first_frame >= file.frames_end() and group.shot < file.shot_count, "GRUP: wrong place")
        require(not file.groups or group.shot >= file.groups[-1].shot, "GRUP: shots out of order")
        newest = max(file.references, default=-1)
        require(group.shot >= newest, "GRUP: shots out of order")
        if file.sound():
            require(group.shot == newest and group.first_frame == file.frames_end(), "GRUP: does not follow")
        file.groups.append(group)
        self.note(chunk, group.frame_count)


@dataclass
class MeshHeader:
    """reference_mesh.md, front."""
    vertex_count: int
    face_count: int
    flags: int
    draco_bytes: int
    rest_bytes: int
    position_bytes: int
    order_bytes: int
    face_bytes: int


def read_mesh_header(reader):
    vertex_count = reader.uv("vertex_count", 1, 1 << 25)
    face_count = reader.uv("face_count", 0, UINT32)
    flags = reader.flags("flags", ORDER_KEPT | FACE_ORDER_KEPT | PLAIN)
    draco_bytes, rest_bytes = (reader.uv("section length", 0, UINT32) for _ in range(2))
    position_bytes = reader.uv("position_bytes", 0, UINT32) if flags & PLAIN else 0
    order_bytes = reader.uv("order_bytes", 0, UINT32)
    face_bytes = reader.uv("face_bytes", 0, UINT32) if flags & FACE_ORDER_KEPT else 0
    return MeshHeader(vertex_count, face_count, flags, draco_bytes, rest_bytes, position_bytes, order_bytes, face_bytes)


def with_end_as_fault(function, *arguments):
    """A chunk whose checksum is right but whose fields run past its end is corrupt, not truncated."""
    try:
        return function(*arguments)
    except Truncated as fault:
        raise Corrupt(str(fault))


def read_file(data):
    return FileReader(data).read()
