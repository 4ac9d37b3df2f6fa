"""attributes.md sections 4 and 5: wedges, and the sites that attributes have values at."""
from dataclasses import dataclass

from .attribute_chunks import FACE, SHOT, VERTEX
from .entropy import AdaptiveBit
from .half_edges import NONE
from .order import dual_triangles


class Corners:
    """Section 4: corners of faces and their twins."""

    def __init__(self, faces):
        self.vertex = [v for face in faces for v in face]
        self.face, self.following, self.preceding = [], [], []
        for f, face in enumerate(faces):
            first = len(self.face)
            self.face += [f] * len(face)
            self.following += [first + (i + 1) % len(face) for i in range(len(face))]
            self.preceding += [first + (i - 1) % len(face) for i in range(len(face))]
        edges = {}
        for c, v in enumerate(self.vertex):
            w = self.vertex[self.following[c]]
            if v != w:
                edges.setdefault((min(v, w), max(v, w)), []).append(c)
        self.twin = [NONE] * len(self.vertex)
        for pair in edges.values():
            if len(pair) == 2 and self.vertex[pair[0]] != self.vertex[pair[1]]:
                self.twin[pair[0]], self.twin[pair[1]] = pair[1], pair[0]

    def joints(self):
        """(corner, corner, whether at the start of the edge)."""
        for c, t in enumerate(self.twin):
            if t > c:
                yield c, self.following[t], True
                yield self.following[c], t, False


class Sets:
    def __init__(self, count):
        self.parent = list(range(count))

    def lowest(self, c):
        while self.parent[c] != c:
            c = self.parent[c]
        return c

    def join(self, a, b):
        a, b = self.lowest(a), self.lowest(b)
        self.parent[max(a, b)] = min(a, b)


def decode_wedges(decoder, corners):
    """Section 4: (wedge of each corner, vertex of each wedge)."""
    count = len(corners.vertex)
    fans = Sets(count)
    for a, b, _ in corners.joints():
        fans.join(a, b)
    fan = [fans.lowest(c) for c in range(count)]
    size, left, seams = [0] * count, [0] * count, [0] * count
    for c in range(count):
        size[fan[c]] += 1
    for a, _, _ in corners.joints():
        left[fan[a]] += 1
    closed = [left[f] == size[f] for f in range(count)]
    models = {}
    sets = Sets(count)
    before = 0
    for a, b, at_start in corners.joints():
        f = fan[a]
        if closed[f] and left[f] == 1 and seams[f] < 2:
            bit = seams[f]
        else:
            context = (min(seams[f], 2), min(left[f], 4) if closed[f] else 5, 0 if at_start else 1 + before)
            bit = models.setdefault(context, AdaptiveBit()).decode(decoder)
        left[f] -= 1
        seams[f] += bit
        if not bit:
            sets.join(a, b)
        before = bit
    wedge, vertex = [], []
    for c in range(count):
        lowest = sets.lowest(c)
        wedge.append(len(vertex) if lowest == c else wedge[lowest])
        if lowest == c:
            vertex.append(corners.vertex[c])
    return wedge, vertex


@dataclass
class Sites:
    """Section 5."""
    grid: list
    triangles: list  # flat
    of_element: list  # site of every element
    vertex: list = None  # of every wedge


def fans_of(faces):
    flat = []
    for face in faces:
        for i in range(1, len(face) - 1):
            triangle = [face[0], face[i], face[i + 1]]
            if len(set(triangle)) == 3:
                flat += triangle
    return flat


def decode_sites(decoder, domain, grid, faces):
    """`grid`: of the vertices in output order."""
    if domain == VERTEX:
        return Sites(grid, fans_of(faces), list(range(len(grid))))
    if domain == SHOT:
        return Sites([(0, 0, 0)], [], [0])
    if domain == FACE:
        middle = [tuple(sum(grid[v][i] for v in face) // len(face) for i in range(3)) for face in faces]
        return Sites(middle, dual_triangles(faces), list(range(len(faces))))
    corners = Corners(faces)
    wedge, vertex = decode_wedges(decoder, corners)
    named, first = [], 0
    for face in faces:
        named.append(wedge[first:first + len(face)])
        first += len(face)
    return Sites([grid[v] for v in vertex], fans_of(named), wedge, vertex)
