"""reference_mesh.md section 2.2: positions of points. Reals are binary64."""
import math

from .arithmetic import clamp
from .half_edges import NONE, after, before, coding_order, edges_from, find_twins
from .guesses import Guess, GuessMixture

GRID_SIZE = 65536


def mean(values):
    total = 0.0
    for x in values:
        total = total + x
    return total / len(values)


def cholesky(matrix, least):
    """L of a symmetric 3 x 3 matrix."""
    L = [[0.0] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(i + 1):
            s = matrix[i][j]
            for k in range(j):
                s = s - L[i][k] * L[j][k]
            L[i][j] = math.sqrt(max(s, least)) if i == j else s / L[j][j]
    return L


class FeatureWeights:
    """N and r of a class, and the weights w that follow from them."""

    def __init__(self):
        self.N = [[0.0] * 3 for _ in range(3)]
        self.r = [0.0] * 3

    def solve(self):
        damped = [[self.N[i][j] * 1.001 + 30 if i == j else self.N[i][j] for j in range(3)] for i in range(3)]
        L = cholesky(damped, 1e-9)
        w = [0.0] * 3
        for i in range(3):
            s = self.r[i]
            for k in range(i):
                s = s - L[i][k] * w[k]
            w[i] = s / L[i][i]
        for i in (2, 1, 0):
            for k in range(i + 1, 3):
                w[i] = w[i] - L[k][i] * w[k]
            w[i] = w[i] / L[i][i]
        return w

    def observe(self, features, error_near, error, target):
        c = 1 / (0.3 + error_near * error_near + error * error)
        for i in range(3):
            f = c * features[i]
            for j in range(i + 1):
                self.N[i][j] += f * features[j]
            self.r[i] += f * target


class SeamFinder:
    """Partners across a seam, paragraph *Seam*."""

    def __init__(self, triangles, twins, fans):
        self.triangles, self.twins, self.fans = triangles, twins, fans
        self.partner = {}
        self.latest = {}  # by position

    def boundary_neighbours(self, v):
        found = []
        for h in self.fans[v]:
            if len(found) >= 16:
                break
            if self.twins[h] == NONE:
                found.append(self.triangles[after(h)])
            if self.twins[before(h)] == NONE:
                found.append(self.triangles[before(h)])
        return found

    def candidates(self, v, coded):
        found = []
        for n in self.boundary_neighbours(v):
            if not coded(n) or n not in self.partner:
                continue
            for c in self.boundary_neighbours(self.partner[n]):
                if coded(c) and c not in found and len(found) < 2:
                    found.append(c)
        return found

    def note(self, v, position):
        if not self.boundary_neighbours(v):
            return
        if position in self.latest:
            other = self.latest[position]
            self.partner[v] = other
            self.partner[other] = v
        self.latest[position] = v


class PointDecoder:
    def __init__(self, decoder, count, triangles):
        self.decoder = decoder
        self.count = count
        self.triangles = triangles
        self.twins = find_twins(triangles)
        self.fans = edges_from(count, triangles)
        self.neighbours = [self.list_neighbours(v) for v in range(count)]
        self.position = [None] * count
        self.error = [0.0] * count
        self.latest = None  # position of the point coded before
        self.classes = [FeatureWeights() for _ in range(4)]
        self.mixture = GuessMixture(35, 256)
        self.seam = SeamFinder(triangles, self.twins, self.fans)

    def list_neighbours(self, v):
        found = []
        for h in self.fans[v]:
            found.append(self.triangles[after(h)])
            if self.twins[before(h)] == NONE:
                found.append(self.triangles[before(h)])
        return found

    def decode_all(self):
        for v in coding_order(self.count, self.triangles):
            self.decode_point(v)
            self.decoder.check()
        return self.position

    def parallelograms(self, v):
        found = []
        for h in self.fans[v]:
            ab = after(h)
            if self.twins[ab] == NONE:
                continue
            corners = (self.triangles[ab], self.triangles[after(ab)], self.triangles[before(self.twins[ab])])
            if all(self.position[p] is not None for p in corners):
                found.append([self.position[p] for p in corners])
        return found

    def coded_neighbours(self, v):
        return [n for n in self.neighbours[v] if self.position[n] is not None]

    def base_and_features(self, near, tips, axis):
        x = [float(self.position[n][axis]) for n in near]
        if tips:
            base = mean([tip[axis] for tip in tips])
        elif near:
            base = mean(x)
        else:
            base = 0.0 if self.latest is None else float(self.latest[axis])
        smooth = []
        missing_one = []
        for n in near:
            known = [self.position[m][axis] for m in self.coded_neighbours(n)]
            if known:
                own = self.position[n][axis]
                smooth.append(2.0 * own - float(sum(known)) / len(known))
                if len(self.neighbours[n]) == len(known) + 1:
                    missing_one.append((len(known) + 1.0) * own - float(sum(known)))
        features = [mean(values) - base if values else 0.0 for values in (x, smooth, missing_one)]
        return base, features

    def decode_point(self, v):
        near = self.coded_neighbours(v)
        parallelograms = self.parallelograms(v)
        tips = [[c[i] + float(a[i] - c[i]) + float(b[i] - c[i]) for i in range(3)] for a, b, c in parallelograms]
        n_P = len(tips)
        weights = self.classes[min(n_P, 3)]
        w = weights.solve()
        error_near = mean([self.error[n] for n in near]) if near else 0.0
        spread = 0.3 + 0.7 * self.deviation(tips) / 3
        L = self.error_shape(parallelograms)
        candidates = [self.position[c] for c in self.seam.candidates(v, lambda p: self.position[p] is not None)]
        situation = 1 + min(n_P, 3) if n_P else 1 if len(near) > 1 else 0
        z = [0.0] * 3
        errors = 0.0
        position = []
        for axis in range(3):
            base, features = self.base_and_features(near, tips, axis)
            fitted = base
            for k in range(3):
                fitted = fitted + w[k] * features[k]
            sigma = error_near + 0.3
            if axis > 0:
                sigma = max((2 * sigma + errors / axis) / 3, 0.3)
            along = 0.0
            for k in range(axis):
                along = along + L[axis][k] * z[k]

            guesses = [guess(situation, base, sigma)] if n_P < 2 else []
            guesses.append(guess(10 + situation, fitted, spread))
            if not near:
                guesses.append(guess(25 + situation, base, sigma))
            for c in candidates:
                guesses.append(guess(30 + (1 if axis > 0 else 0), float(c[axis]), 0.3))
            if n_P > 0:
                guesses.append(guess(20 + situation, fitted + along, sigma * L[axis][axis]))
            if n_P > 1:
                guesses.append(guess(5 + situation, fitted, sigma))
                for tip in tips[:2]:
                    guesses.append(guess(15 + situation, tip[axis], sigma))
            x = self.mixture.decode(self.decoder, guesses, GRID_SIZE)

            e = x - fitted
            errors += abs(e)
            s = e
            for k in range(axis):
                s = s - L[axis][k] * z[k]
            z[axis] = s / L[axis][axis]
            weights.observe(features, error_near, e, x - base)
            candidates = [c for c in candidates if c[axis] == x]
            position.append(x)
        self.error[v] = errors / 3
        self.latest = self.position[v] = tuple(position)
        self.seam.note(v, self.position[v])

    @staticmethod
    def deviation(tips):
        """d of *spread*."""
        d = 0.0
        for i in range(3):
            if not tips:
                continue
            m = mean([tip[i] for tip in tips])
            q = 0.0
            for tip in tips:
                q = q + tip[i] * tip[i]
            d = d + math.sqrt(max(q / len(tips) - m * m, 0.0))
        return d

    @staticmethod
    def error_shape(parallelograms):
        """L, the Cholesky factor of C."""
        n = [0.0] * 3
        for a, b, c in parallelograms:
            u = [float(a[i] - c[i]) for i in range(3)]
            v = [float(b[i] - c[i]) for i in range(3)]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                n[i] = n[i] + (u[j] * v[k] - u[k] * v[j])
        square = 0.0
        for x in n:
            square = square + x * x
        g = (0.05 - 1) / square if square > 0 else 0.0
        return cholesky([[(1.0 if i == j else 0.0) + g * n[i] * n[j] for j in range(3)] for i in range(3)], 1e-6)


def guess(kind, place, scale):
    fixed = math.floor(256 * clamp(place, -1e6, 1e6) + 0.5) + 128
    return Guess(kind, fixed, int(clamp(256 * scale, 64.0, 16777216.0)))
