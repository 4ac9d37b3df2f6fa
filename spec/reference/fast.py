"""fast.md sections 2 to 5: the order of contraction, lane fields, their weights, plain meshes."""
import math
from bisect import bisect_left

from .arithmetic import f32, floor_log2, product32, sum32
from .half_edges import NONE, after, before, coding_order, edges_from
from .errors import require
from .lanes import LaneSection
from .surface import STEPS, Distances, Row, make_row, set_step_indices

LIST = 16
AROUND = 12


class Contraction:
    """Section 2."""

    def __init__(self, vertex_count, triangles):
        self.N = [[] for _ in range(vertex_count)]
        self.full = [False] * vertex_count
        for i in range(0, len(triangles), 3):
            a, b, c = triangles[i:i + 3]
            for v, others in ((a, (b, c)), (b, (c, a)), (c, (a, b))):
                for u in others:
                    self.add(v, u)
        self.isolated = [v for v in range(vertex_count) if not self.N[v]]
        self.alive = [v for v in range(vertex_count) if self.N[v]]
        self.removed = []  # (vertex, ring, far)
        tries = 32 * len(self.alive)
        while 64 < len(self.alive) <= tries:
            tries -= len(self.alive)
            removed = self.sweep()
            if removed < max(1, len(self.alive) // 200):
                break

    def add(self, v, u):
        if u in self.N[v]:
            return
        if len(self.N[v]) < LIST:
            self.N[v].append(u)
        else:
            self.full[v] = True

    def sweep(self):
        locked = set()
        gone = set()
        for v in self.alive:
            if v in locked or self.full[v] or not 0 < len(self.N[v]) <= 9:
                continue
            t = self.target(v)
            if t is None:
                continue
            ring = list(self.N[v])
            self.removed.append((v, ring, self.far(v)))
            locked |= set(ring)
            self.contract(v, t)
            gone.add(v)
        self.alive = [v for v in self.alive if v not in gone]
        return len(gone)

    def target(self, v):
        N = self.N
        allowed = [t for t in N[v] if not self.full[t] and len(N[t]) <= LIST - len(N[v])]
        return min(allowed, key=lambda t: len(N[t])) if allowed else None

    def contract(self, v, t):
        N = self.N
        for w in N[v]:
            if v in N[w]:
                at = N[w].index(v)
                if w == t or t in N[w]:
                    N[w][at] = N[w][-1]
                    N[w].pop()
                else:
                    N[w][at] = t
        for w in N[v]:
            if w != t:
                self.add(t, w)
        N[v] = []

    def far(self, v):
        once, again = [], []
        near = set(self.N[v]) | {v}
        for u in self.N[v]:
            for w in self.N[u]:
                if w in near:
                    continue
                if w not in once:
                    once.append(w)
                elif w not in again:
                    again.append(w)
        return (again + [w for w in once if w not in again])[:AROUND - len(self.N[v])]


class Order:
    """Rows before their positions are known: the vertex, the neighbours and the ring of each."""

    def __init__(self, vertex_count, triangles):
        found = Contraction(vertex_count, triangles)
        self.order = found.alive + [v for v, _, _ in reversed(found.removed)] + found.isolated
        rank = {v: r for r, v in enumerate(self.order)}
        ring = {v: near for v, near, _ in found.removed}
        far = {v: beyond for v, _, beyond in found.removed}
        self.neighbours = []
        self.ring = []
        for r, v in enumerate(self.order):
            if v in ring:
                self.neighbours.append([rank[u] for u in ring[v] + far[v]])
                self.ring.append(len(ring[v]))
            else:
                self.neighbours.append([r - i for i in range(1, 5) if r - i >= 0])
                self.ring.append(min(r, 1))


class LaneWeights:
    """Section 4: the weights of a row, all in binary32."""

    def __init__(self, rows, index, points):
        """points: grid position of every row."""
        row = self.row = rows[index]
        self.index = index
        n = self.n = len(row.neighbours)
        y = [[float(points[k][a] - points[index][a]) for a in range(3)] for k in row.neighbours]
        self.M = [[dot32(y[i], y[j]) for j in range(i + 1)] for i in range(n)]
        spread = 0.0
        for i in range(n):
            spread = sum32(spread, self.M[i][i])
        share = f32(1 / sum32(0.25, product32(2.0 ** -11, f32(spread / max(1, n)))))
        self.M = self.start = [[product32(x, share) for x in entries] for entries in self.M]

    def observe(self, planes, share):
        """The differences of eight planes."""
        own = [plane[self.index] for plane in planes]
        z = [[sum32(plane[k], -x) for plane, x in zip(planes, own)] for k in self.row.neighbours]
        for i in range(self.n):
            for j in range(i + 1):
                self.M[i][j] = sum32(self.M[i][j], product32(share, dot32(z[i], z[j])))

    def solve(self):
        A = [list(entries) for entries in self.M]
        w = []
        for i in range(self.n):
            sure = product32(self.row.precision[i], 0.25 if i < self.row.ring else 0.625)
            A[i][i] = sum32(A[i][i], sure)
            w.append(product32(self.row.prior[i], sure))
        b = [1.0] * self.n
        solve_system32(A, [w, b])
        constrain32(w, b)
        return w


def dot32(a, b):
    out = product32(a[0], b[0])
    for x, y in zip(a[1:], b[1:]):
        out = sum32(out, product32(x, y))
    return out


def solve_system32(A, sides):
    n = len(A)
    rows = A + sides
    diagonal, c = [0.0] * n, [0.0] * n
    for j in range(n):
        d = A[j][j]
        least = product32(d, 2.0 ** -20)
        for k in range(j):
            c[k] = product32(A[j][k], diagonal[k])
            d = sum32(d, -product32(A[j][k], c[k]))
        inverse = 0.0
        if d > least:
            diagonal[j] = d
            inverse = f32(1 / d)
        for row in rows[j + 1:]:
            x = row[j]
            for k in range(j):
                x = sum32(x, -product32(row[k], c[k]))
            row[j] = product32(x, inverse)
    for x in sides:
        for k in range(n - 1, 0, -1):
            for i in range(k):
                x[i] = sum32(x[i], -product32(A[k][i], x[k]))


def constrain32(w, b):
    sum_w, sum_b = 0.0, 0.0
    for x, y in zip(w, b):
        sum_w, sum_b = sum32(sum_w, x), sum32(sum_b, y)
    f = f32(sum32(1.0, -sum_w) / sum_b) if sum_b > 0 else 0.0
    for i in range(len(w)):
        w[i] = sum32(w[i], product32(b[i], f))


class LaneField:
    """Section 3. weights, steps: of every row; learners: LaneWeights of every row, or None where the weights are kept."""

    def __init__(self, data, rows, planes, weights, steps, learners=None, wary=False):
        self.wary = wary
        self.section = LaneSection(data, min(16, planes))
        self.rows = rows
        self.weights = weights
        self.steps = steps
        self.history = [0] * len(rows)
        self.planes = [[0.0] * len(rows) for _ in range(planes)]
        for block in range((planes + 8 + 15) // 16 if planes > 0 else 0):
            first = max(0, 16 * block - 8)
            if learners and block in (1, 2):
                self.learn(learners, block)
            self.decode_block(block, first, min(16 * block + 8, planes) - first)
        self.section.check()

    def learn(self, learners, block):
        for r, learner in enumerate(learners):
            if self.history[r] < 4 * block:
                continue
            learner.M = [list(entries) for entries in learner.start]
            for first in (0,) if block == 1 else (0, 8, 16):
                learner.observe(self.planes[first:first + 8], self.share(r))
            self.weights[r] = learner.solve()

    def share(self, r):
        if not self.wary:
            return 0.125
        h = product32(float(self.history[r]), 0.0625)
        return f32(1 / sum32(8.0, product32(2.0, product32(h, h))))

    def decode_block(self, block, first, lanes):
        self.magnitude = [[0] * lanes for _ in self.rows]
        self.running, self.before = [0] * lanes, [0] * lanes
        for r in range(len(self.rows)):
            for lane in range(lanes):
                n, _ = self.section.decode(lane, self.classify(block, r, lane))
                plane = self.planes[first + lane]
                plane[r] = self.value(r, plane, n)
                require(math.isfinite(plane[r]), "a value is beyond binary32")
                magnitude = min(abs(n), 255)
                self.magnitude[r][lane] = magnitude
                self.before[lane] = self.running[lane]
                self.running[lane] += 32 * magnitude - (self.running[lane] >> 3)
        for r, magnitudes in enumerate(self.magnitude):
            m = sum(magnitudes)
            self.history[r] = 2 * m if block == 0 else (self.history[r] + 3 * m) // 4

    def value(self, r, plane, n):
        s = [0.0] * 4
        for i, k in enumerate(self.rows[r].neighbours):
            s[i % 4] = sum32(s[i % 4], product32(self.weights[r][i], plane[k]))
        p = sum32(sum32(s[0], s[1]), sum32(s[2], s[3]))
        return sum32(p, product32(f32(n), f32(self.steps[r] / 65536)))

    def classify(self, block, r, lane):
        row = self.rows[r]
        mean = self.before[lane] >> 4
        near = mean
        if row.ring > 0:
            total = sum(self.magnitude[k][lane] for k in row.neighbours[:row.ring])
            near = (total * (65536 // row.ring)) >> 12
        if block == 0:
            expected = (10 * near + 6 * mean) >> 4
        else:
            expected = (6 * mean + 10 * self.history[r]) >> 4
        return size_class(expected)


def size_class(expected):
    """Half an octave each, of a magnitude in 1/16."""
    e = floor_log2(expected + 1)
    below = (expected + 1) >> (e - 1) & 1 if e > 0 else 0
    return min(19, 2 * e + below)


class Walk:
    """Section 5: the order of vertices and, at each, the triangles known before: (a, b, c), c maybe NONE."""

    def __init__(self, vertex_count, triangles):
        fans = edges_from(vertex_count, triangles)
        self.order = coding_order(vertex_count, triangles)
        turn = self.turn = {}
        self.known = []
        for v in self.order:
            turn[v] = len(turn)
            known = []
            for h in fans[v]:
                a, b = triangles[after(h)], triangles[before(h)]
                if a in turn and b in turn and len(known) < 16:
                    known.append((a, b, self.across(triangles, fans, a, b, turn, v)))
            self.known.append(known)

    @staticmethod
    def across(triangles, fans, a, b, turn, v):
        for h in fans[b][:16]:
            if triangles[after(h)] == a:
                c = triangles[before(h)]
                return c if c in turn and c != v else NONE
        return NONE


def decode_positions(data, walk):
    """Section 5: grid position of every vertex."""
    section = LaneSection(data, 3)
    place, magnitude = {}, {}
    running = [0] * 3
    for turn, v in enumerate(walk.order):
        position, m = [], []
        for axis in range(3):
            p, expected = guess_position(walk, turn, axis, place, magnitude, running[axis] >> 4)
            n, _ = section.decode(axis, size_class(expected))
            position.append(p + n)
            require(0 <= p + n <= 65535, "a position is off the grid")
            m.append(min(abs(n), 255))
            running[axis] += 32 * m[axis] - (running[axis] >> 3)
        place[v], magnitude[v] = position, m
    section.check()
    return [tuple(place[v]) for v in range(len(walk.order))]


def guess_position(walk, turn, axis, place, magnitude, recent):
    known = walk.known[turn]
    tips = [place[a][axis] + place[b][axis] - place[c][axis] for a, b, c in known if c != NONE]
    ends = [u for a, b, _ in known for u in (a, b)]
    near = recent
    if ends:
        near = (sum(magnitude[u][axis] for u in ends) * (65536 // len(ends))) >> 12
    usual = (10 * near + 6 * recent) >> 4
    if len(tips) > 1:
        return rounded_mean(tips), (5 * usual + 32 * (max(tips) - min(tips))) >> 3
    if tips:
        return tips[0], (5 * usual) >> 2
    if ends:
        return rounded_mean([place[u][axis] for u in ends]), 2 * usual
    return (place[walk.order[turn - 1]][axis] if turn > 0 else 0), 2 * usual


def rounded_mean(values):
    p = product32(float(sum(values)), f32(1 / len(values)))
    return int(sum32(sum32(p, 12582912.0), -12582912.0))


class IndexGuesses:
    """Section 5, *Order*: the guesses of one vertex, (kind, index)."""

    def __init__(self, walk, turn, output, taken, cost):
        self.cost = cost
        self.all = []
        known = walk.known[turn]
        tips = [output[a] + output[b] - output[c] for a, b, c in known if c != NONE][:2]
        guesses = list(enumerate(tips))
        if turn > 0:
            guesses.append((2, output[walk.order[turn - 1]] + 1))
        latest = sorted({walk.turn[u] for a, b, _ in known for u in (a, b)}, reverse=True)[:4]
        for i, t in enumerate(latest):
            near = output[walk.order[t]]
            guesses += [(4 + i, near + 1), (8 + i, near - 1)]
        self.all = [(kind, g) for kind, g in guesses if 0 <= g < len(walk.order) and g not in taken]
        self.best = min(cost[kind] for kind, _ in self.all) if self.all else None

    def ordered(self):
        """Every index once, the best first."""
        found = []
        for _, g in sorted(self.all, key=lambda guess: (self.cost[guess[0]], guess[0])):
            if g not in found:
                found.append(g)
        return found

    def note(self, index):
        for kind, g in self.all:
            x = min(abs(g - index), 1 << 20) + 1
            e = floor_log2(x)
            size = 16 * (32 * e + (32 * x >> e) - 32)
            self.cost[kind] += (size - self.cost[kind]) >> 4


def decode_plain_order(data, walk):
    """Section 5: the output index of every coding vertex."""
    count = len(walk.order)
    section = LaneSection(data, 1)
    output = {}
    free = list(range(count))
    taken = set()
    cost = [4096] * 12
    for turn, v in enumerate(walk.order):
        guesses = IndexGuesses(walk, turn, output, taken, cost)
        index = decode_index(section, guesses, free, output[walk.order[turn - 1]] + 1 if turn > 0 else 0)
        guesses.note(index)
        output[v] = index
        taken.add(index)
        free.pop(bisect_left(free, index))
    section.check()
    return [output[v] for v in range(count)]


def decode_index(section, guesses, free, behind):
    ordered = guesses.ordered()
    s = 1
    if ordered:
        _, s = section.decode(0, min(9, guesses.best >> 9))
    if s == 1:
        n, _ = section.decode(0, 10 + min(9, 3 * (guesses.best if ordered else 6144) >> 11))
        r = bisect_left(free, ordered[0] if ordered else behind) + n
        require(0 <= r < len(free), "an index that cannot be")
        return free[r]
    place = max(s - 1, 0)
    require(place < len(ordered), "a guess that is not there")
    return ordered[place]


def build_fast_graph(grid, order):
    """(rows, order) as surface.build_surface_graph gives them."""
    distances = Distances(grid)
    rank = {v: r for r, v in enumerate(order.order)}
    rows = []
    for v, neighbours, ring in zip(order.order, order.neighbours, order.ring):
        vertices = [order.order[k] for k in neighbours]
        rows.append(make_row(v, vertices[:ring], vertices[ring:], rank, distances))
    set_step_indices(rows)
    return rows, order.order


def decode_coefficients(data, rows, components, positions, wary):
    learners = [LaneWeights(rows, r, positions) for r in range(len(rows))]
    weights = [learner.solve() for learner in learners]
    steps = [STEPS[row.step_index] for row in rows]
    return LaneField(data, rows, components, weights, steps, learners, wary).planes


def decode_basis(data, rows, components):
    return LaneField(data, rows, components, [row.prior for row in rows], [65536] * len(rows)).planes
