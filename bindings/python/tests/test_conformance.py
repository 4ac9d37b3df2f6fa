"""Every conformance stream gives, through NumPy arrays, the bytes that two other decoders agree on."""
import hashlib
import json
import struct

import pytest
from conftest import STREAMS

import reeb

STATUS = {
    "corrupt": reeb.CorruptError,
    "truncated": reeb.TruncatedError,
    "unsupported": reeb.UnsupportedError,
    "limit exceeded": reeb.LimitError
}
CASES = [(kind, name, expected) for kind in ("core", "uncommon", "faulty")
         for name, expected in json.loads((STREAMS / kind / "test.json").read_text()).items()]


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def mesh_bytes(shot):
    faces = shot.polygons
    counts = struct.pack("<3I", shot.vertex_count, len(faces), len(faces.corners))
    return counts + faces.sizes.tobytes() + faces.corners.tobytes()


class Given:
    """What a sequence gives, as test.json has it, and the first error."""

    def __init__(self, sequence):
        self.error = reeb.TruncatedError("the file ends early") if sequence.truncated else None
        self.frames, self.output = [], b""
        told = set()
        for t in range(sequence.total_frames):
            try:
                shot = sequence.shots[sequence.shot_of(t)]
                xyz = sequence[t].tobytes()
                connectivity = mesh_bytes(shot)
            except (reeb.ReebError, IndexError) as error:
                self.note(error if isinstance(error, reeb.ReebError) else reeb.CorruptError(str(error)))
                continue
            self.frames.append({"frame": t, "positions": sha256(xyz), "connectivity": sha256(connectivity)})
            self.output += struct.pack("<I", t) + connectivity + xyz
            for info in shot.attributes.all:
                if info.animated or (shot.index, info.index) not in told:
                    told.add((shot.index, info.index))
                    self.add_attribute(sequence, t, info)

    def add_attribute(self, sequence, t, info):
        try:
            values = sequence.attribute(info)[t].tobytes()
        except reeb.ReebError as error:
            self.note(error)
            return
        self.frames[-1].setdefault("attributes", {})[str(info.index)] = sha256(values)
        self.output += struct.pack("<4I", 0xFFFFFFFF, t, info.index, len(values)) + values

    def note(self, error):
        self.error = self.error or error


@pytest.mark.parametrize("kind, name, expected", CASES, ids=[f"{kind}-{name}" for kind, name, _ in CASES])
def test_stream(kind, name, expected):
    try:
        sequence = reeb.open((STREAMS / kind / f"{name}.reeb").read_bytes())
    except reeb.ReebError as error:
        assert type(error) is STATUS[expected["status"]]
        assert expected["frames"] == []
        return
    given = Given(sequence)
    if expected["status"] == "ok":
        assert given.error is None
    else:
        assert type(given.error) is STATUS[expected["status"]]
    if isinstance(expected["frames"], dict):
        assert expected["frames"] == {"count": len(given.frames), "output": sha256(given.output)}
    else:
        assert given.frames == expected["frames"]
