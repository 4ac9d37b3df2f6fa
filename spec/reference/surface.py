"""prediction.md sections 1 to 3: the surface graph of a reference mesh."""
import math

from .arithmetic import clamp, f32, log2_5


class Row:
    """What a graph has of a row."""

    def __init__(self, neighbours, ring, prior, precision, step_index=0):
        self.neighbours = neighbours
        self.ring = ring
        self.prior = prior
        self.precision = precision
        self.step_index = step_index


class Distances:
    def __init__(self, grid):
        self.grid = grid

    def d2(self, u, v):
        p, q = self.grid[u], self.grid[v]
        return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2

    def d4(self, u, v):
        return math.isqrt(256 * self.d2(u, v))


class Collapser:
    """Section 1.1 and 1.2."""

    def __init__(self, distances, vertex_count, triangles):
        self.distances = distances
        corners = [0] * vertex_count
        for v in triangles:
            corners[v] += 1
        self.F = [set() for _ in range(vertex_count)]
        self.N = [set() for _ in range(vertex_count)]
        self.triangle = []
        for i in range(0, len(triangles), 3):
            corner = triangles[i:i + 3]
            if any(corners[v] > 256 for v in corner):
                continue
            for v in corner:
                self.F[v].add(len(self.triangle))
                self.N[v] |= set(corner) - {v}
            self.triangle.append(corner)
        self.isolated = [v for v in range(vertex_count) if not self.N[v]]
        self.alive = [v for v in range(vertex_count) if self.N[v]]
        self.removed = []  # (vertex, ring, far), the first removed first

    def run(self):
        tries = 32 * len(self.alive)
        while 64 < len(self.alive) <= tries:
            tries -= len(self.alive)
            removed = self.sweep()
            if removed < max(1, len(self.alive) // 200):
                break

    def sweep(self):
        N = self.N
        locked = set()
        gone = set()
        d4 = self.distances.d4
        keys = [(sum(d4(v, u) for u in N[v]) // max(1, len(N[v])), v) for v in self.alive]
        for _, v in sorted(keys):
            if v in locked or not 0 < len(N[v]) <= 9:
                continue
            t = self.target(v)
            if t is None:
                continue
            self.removed.append((v, sorted(N[v]), self.far(v)))
            locked |= N[v]
            self.collapse(v, t)
            gone.add(v)
        self.alive = [v for v in self.alive if v not in gone]
        return len(gone)

    def target(self, v):
        F, N = self.F, self.N
        wanted = 0 if not F[v] else 2 if len(F[v]) == len(N[v]) else 1
        allowed = []
        for u in N[v]:
            small = len(N[u]) + len(N[v]) <= 16
            shared = sum(1 for f in F[v] if u in self.triangle[f])
            sound = len(N[v]) <= 2 or (shared == wanted and len(N[u] & N[v]) == wanted)
            if small and sound:
                allowed.append((self.distances.d2(v, u), u))
        return min(allowed)[1] if allowed else None

    def far(self, v):
        def by_distance(vertices):
            return sorted(vertices, key=lambda u: (self.distances.d2(v, u), u))

        met = {v} | self.N[v]
        second = by_distance({w for u in self.N[v] for w in self.N[u]} - met)
        found = list(second)
        if len(second) < 10:
            met |= set(second)
            found += by_distance({w for u in second for w in self.N[u]} - met)
        return found[:10]

    def collapse(self, v, t):
        F, N = self.F, self.N
        for f in list(F[v]):
            if t in self.triangle[f]:
                for w in self.triangle[f]:
                    F[w].discard(f)
            else:
                self.triangle[f] = [t if w == v else w for w in self.triangle[f]]
                F[t].add(f)
        F[v] = set()
        for w in N[v]:
            N[w].discard(v)
            if w != t:
                N[w].add(t)
                N[t].add(w)
        N[v] = set()


def by_strides(grid, vertices):
    """Section 1.3."""
    def morton(p):
        return sum(((p[a] >> j) & 1) << (3 * j + a) for j in range(16) for a in range(3))

    s = sorted(vertices, key=lambda v: (morton(grid[v]), v))
    n = len(s)
    order = s[:1]
    stride = 1 << max(0, n - 1).bit_length()
    while stride >= 1:
        order += [s[i] for i in range(stride, n, 2 * stride)]
        stride //= 2
    return order


def boundary_vertices(triangles):
    times = {}
    for i in range(0, len(triangles), 3):
        for j in range(3):
            a, b = triangles[i + j], triangles[i + (j + 1) % 3]
            edge = (min(a, b), max(a, b))
            times[edge] = times.get(edge, 0) + 1
    return {v for edge, count in times.items() if count == 1 for v in edge}


def complete_neighbours(v, ring, far, earlier, distances, is_boundary):
    """Section 2: adds near earlier vertices to ring and far where they are few."""
    alone = not ring
    if not (alone or is_boundary or len(ring) + len(far) < 12):
        return
    coincident = 0
    nearest = sorted(earlier, key=lambda u: (distances.d2(v, u), u))[:16]
    for u in nearest:
        if u in ring or u in far:
            continue
        if alone and len(ring) < 4:
            ring.append(u)
        elif distances.d2(v, u) == 0 and coincident < 2:
            ring.insert(0, u)
            coincident += 1
        elif len(ring) + len(far) < 16:
            far.append(u)


def make_row(v, ring, far, rank, distances):
    """Section 2, priors and precision."""
    neighbours = (ring + far)[:16]
    ring = min(len(ring), 16)
    e = [max(4, distances.d4(v, u)) for u in neighbours]
    inverse = [(1 << 22) // x for x in e[:ring]]
    prior = [((x << 16) // sum(inverse)) / 65536 for x in inverse] + [0.0] * (len(e) - ring)
    precision = []
    for i, x in enumerate(e):
        y = float(x * ring) / sum(e[:ring])
        precision.append(f32(clamp(y if i < ring else y * y, 1 / 16, 25.0)))
    return Row([rank[u] for u in neighbours], ring, prior, precision)


def set_step_indices(rows):
    """Section 3."""
    mass = [256] * len(rows)
    for r in range(len(rows) - 1, -1, -1):
        row = rows[r]
        for i in range(row.ring):
            mass[row.neighbours[i]] += (mass[r] * int(65536 * row.prior[i])) >> 16
    for r, row in enumerate(rows):
        row.step_index = min((log2_5(mass[r]) - 256) // 4, 191)


def make_steps():
    steps = []
    power = 1 << 30
    for _ in range(192):
        steps.append(power >> 14)
        power = (power * 1053012196) >> 30
    return steps


STEPS = make_steps()


def build_surface_graph(grid, triangles):
    """(rows, order): order[r] is the coding vertex of row r."""
    distances = Distances(grid)
    collapser = Collapser(distances, len(grid), triangles)
    collapser.run()
    ring = {v: r for v, r, _ in collapser.removed}
    far = {v: f for v, _, f in collapser.removed}
    order = by_strides(grid, collapser.alive)
    order += [v for v, _, _ in reversed(collapser.removed)]
    order += by_strides(grid, collapser.isolated)
    rank = {v: r for r, v in enumerate(order)}
    boundary = boundary_vertices(triangles)
    rows = []
    for r, v in enumerate(order):
        near, beyond = ring.get(v, []), far.get(v, [])
        complete_neighbours(v, near, beyond, order[:r], distances, v in boundary)
        rows.append(make_row(v, near, beyond, rank, distances))
    set_step_indices(rows)
    return rows, order
