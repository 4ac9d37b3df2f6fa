"""attributes.md section 6.1: sites that mirror each other, and what they tell. Reals are binary64."""
import math
from bisect import bisect_left

from .arithmetic import clamp
from .entropy import EVEN
from .half_edges import NONE

MOST_OF_ROW = 16


def decode_plane(decoder):
    """(axis, sum), or None."""
    def bits(count):
        value = 0
        for _ in range(count):
            value = 2 * value + decoder.decode(EVEN)
        return value

    kind = bits(2)
    return (kind - 1, bits(17)) if kind else None


class Pairs:
    """Anchors and triangles that mirror each other at a plane."""

    def __init__(self, sites, plane):
        self.sites, self.anchor = sites, sites.vertex if sites.vertex is not None else list(range(len(sites.grid)))
        grid = sites.grid
        self.low = [min(p[i] for p in grid) for i in range(3)]
        extent = max(max(p[i] for p in grid) - self.low[i] for i in range(3))
        self.width = max(extent // math.isqrt(len(grid)), 1)
        lowest = {}
        for site, anchor in enumerate(self.anchor):
            lowest.setdefault(anchor, site)
        self.cells = sorted((self.cell(grid[site]), site) for site in lowest.values())
        axis, total = plane
        self.partner = {}
        for anchor, site in lowest.items():
            point = list(grid[site])
            point[axis] = total - point[axis]
            near = self.nearest(point)
            if near is not None:
                self.partner[anchor] = self.anchor[near]
        self.triangles = {}
        flat = sites.triangles
        for first in range(0, len(flat), 3):
            corners = flat[first:first + 3]
            self.triangles.setdefault(tuple(sorted(self.anchor[s] for s in corners)), corners)

    def cell(self, point):
        return tuple((point[i] - self.low[i]) // self.width for i in range(3))

    def nearest(self, point):
        x, y, z = self.cell(point)
        best = None
        for row in range(9):
            start = (x - 1 + row // 3, y - 1 + row % 3, z - 1)
            at = bisect_left(self.cells, (start, 0))
            for cell, site in self.cells[at:at + MOST_OF_ROW]:
                if cell > (start[0], start[1], z + 1):
                    break
                distance = sum((a - b) ** 2 for a, b in zip(self.sites.grid[site], point))
                if best is None or distance < best[0]:
                    best = (distance, site)
        return best and best[1]

    def find(self, sites):
        """The sites of a triangle that mirror three, or None."""
        wanted = [self.partner.get(self.anchor[s]) for s in sites]
        if None in wanted:
            return None
        corners = self.triangles.get(tuple(sorted(wanted)))
        if corners is None or len(set(wanted)) < 3:
            return None
        return [next(s for s in corners if self.anchor[s] == anchor) for anchor in wanted]


class MirrorGuess:
    def __init__(self, sites, walk, channels, planar, plane):
        self.walk, self.channels, self.planar = walk, channels, planar
        self.pairs = Pairs(sites, plane) if plane is not None else None
        self.turn = {site: turn for turn, site in enumerate(walk.order)}
        self.latest = {}
        self.error, self.turning = 8.0, -1
        self.same, self.missed, self.targets = NONE, False, None

    def start(self, site, known, values):
        """`values` of the sites before; sets `same`, `targets`."""
        if self.pairs is None:
            return
        self.site, self.values = site, values
        self.missed, self.targets = False, None
        self.last = self.sum = 0.0
        partner = self.pairs.partner.get(self.pairs.anchor[site])
        self.same = self.latest.get(partner, NONE)
        for a, b, _ in known:
            there = self.pairs.find((a, b, site))
            if there is None or any(self.turn[s] >= self.turn[site] for s in there):
                continue
            self.own, self.same = (a, b), there[2]
            self.targets = self.moved(there)
            break

    def moved(self, there):
        a, b, c = (self.values[s] for s in there)
        own_a, own_b = (self.values[s] for s in self.own)
        out = []
        for k in range(self.channels):
            c_k = float(c[k])
            out.append((c_k - float(a[k]) + float(own_a[k]) + c_k - float(b[k]) + float(own_b[k])) / 2)
        if not self.planar:
            return out
        du, dv = float(b[0] - a[0]), float(b[1] - a[1])
        x, y = float(c[0] - a[0]), float(c[1] - a[1])
        edge2 = du * du + dv * dv
        if edge2 == 0:
            return None
        along = (x * du + y * dv) / edge2
        self.beside = (y * du - x * dv) / edge2
        side = self.beside if self.turning >= 0 else -self.beside
        own_du, own_dv = float(own_b[0] - own_a[0]), float(own_b[1] - own_a[1])
        out[0] = float(own_a[0]) + along * own_du - side * own_dv
        out[1] = float(own_a[1]) + along * own_dv + side * own_du
        return out

    def scale(self, k):
        return 0.3 + (self.error if k == 0 else (self.error + self.last) / 2)

    def learn(self, k, value):
        if self.pairs is None:
            return
        self.missed = self.missed or (self.same != NONE and self.values[self.same][k] != value)
        if self.targets is not None:
            self.last = abs(value - self.targets[k])
            self.sum = self.sum + self.last

    def finish(self, coded):
        if self.pairs is None:
            return
        self.latest[self.pairs.anchor[self.site]] = self.site
        if self.targets is None:
            return
        self.error = (7 * self.error + self.sum / float(self.channels)) / 8
        if not self.planar:
            return
        a, b = (self.values[s] for s in self.own)
        area = float(b[0] - a[0]) * float(coded[1] - a[1]) - float(b[1] - a[1]) * float(coded[0] - a[0])
        if area * self.beside != 0:
            self.turning = clamp(self.turning + (1 if area * self.beside > 0 else -1), -8, 8)
