"""The output of a decoder under test, conformance/README.md: reading, hashing, comparing."""
import hashlib
import struct

EXIT_CODES = {"ok": 0, "corrupt": 3, "truncated": 4, "unsupported": 5, "limit exceeded": 6}
LISTED = 64  # frames; of more, only the hash of all is kept
ATTRIBUTE = 0xFFFFFFFF  # in place of a frame's number


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def split(data):
    """(frame, index, hash of values) of every attribute and (frame, hash of positions, hash of connectivity) of every
    frame in the output; index is a number, hashes are text."""
    at = 0
    while at < len(data):
        if len(data) - at < 16:
            raise ValueError("the output ends inside a frame")
        frame, vertices, faces, corners = struct.unpack_from("<4I", data, at)
        if frame == ATTRIBUTE:
            end = at + 16 + corners
            if end > len(data):
                raise ValueError("the output ends inside an attribute of frame %d" % vertices)
            yield vertices, faces, sha256(data[at + 16:end])
            at = end
            continue
        middle = at + 16 + 4 * (faces + corners)
        end = middle + 12 * vertices
        if end > len(data):
            raise ValueError("the output ends inside frame %d" % frame)
        yield frame, sha256(data[middle:end]), sha256(data[at + 4:middle])
        at = end


def summary(data):
    """What test.json holds of an output: hashes of each frame, or of all where they are many."""
    listed = []
    for t, a, b in split(data):
        if isinstance(a, int):
            listed[-1].setdefault("attributes", {})[str(a)] = b
        else:
            listed.append({"frame": t, "positions": a, "connectivity": b})
    return listed if len(listed) <= LISTED else {"count": len(listed), "output": sha256(data)}


def difference(given, wanted):
    """In words, empty where there is none."""
    if given == wanted:
        return ""
    if isinstance(wanted, dict) or isinstance(given, dict):
        return "other frames, or other values in them"
    numbers = [f["frame"] for f in given], [f["frame"] for f in wanted]
    if numbers[0] != numbers[1]:
        return "frames %s, not %s" % numbers
    for key in ("connectivity", "positions", "attributes"):
        differ = [f["frame"] for f, g in zip(given, wanted) if f.get(key) != g.get(key)]
        if differ:
            return "other %s in %d frames, first %d" % (key, len(differ), differ[0])
    return "other frames"
