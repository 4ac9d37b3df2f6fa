"""prediction.md section 4: the temporal graph of a group."""
from .surface import Row


def instants(frames):
    """(time, left, right) in order."""
    found = [(0, [], [])]
    h = (1 << max(0, frames - 1).bit_length()) // 2
    while h >= 1:
        for t in range(h, frames, 2 * h):
            left = [x for x in (t - h, t - 3 * h) if x >= 0]
            right = [x for x in (t + h, t + 3 * h) if x < frames]
            found.append((t, left, right))
        h //= 2
    return found


def priors(left, right):
    if len(left) == 2 and len(right) == 2:
        return [9 / 16, -1 / 16, 9 / 16, -1 / 16]
    if left and right:
        return [0.5] + [0.0] * (len(left) - 1) + [0.5] + [0.0] * (len(right) - 1)
    if left:
        return [1.5, -0.5] if len(left) == 2 else [1.0]
    return []


def build_temporal_graph(frames):
    """(rows, order): order[r] is 3 time + axis of row r."""
    rank = {}
    rows = []
    order = []
    for t, left, right in instants(frames):
        for axis in range(3):
            rank[t, axis] = len(rows)
            order.append(3 * t + axis)
            neighbours = [rank[x, axis] for x in left + right]
            ring = len(neighbours)
            neighbours += [rank[t, b] for b in range(axis)]
            if left:
                neighbours += [rank[left[0], b] for b in range(3) if b != axis]
            extra = len(neighbours) - ring
            rows.append(Row(neighbours, ring, priors(left, right) + [0.0] * extra, [1.0] * len(neighbours)))
    return rows, order
