"""prediction.md section 5: weights of a row. All in binary64."""
import math

from .arithmetic import f32


class WeightOptions:
    def __init__(self, ring_deviation, extra_deviation, sum_to_one):
        self.ring_deviation = ring_deviation
        self.extra_deviation = extra_deviation
        self.sum_to_one = sum_to_one


COEFFICIENT_WEIGHTS = WeightOptions(1.4, 0.9, True)
LOOSE_WEIGHTS = WeightOptions(2.4, 1.5, True)
BASIS_WEIGHTS = WeightOptions(0.5, 0.25, False)


def misses_to_solve(k):
    """Misses that a row's weights are solved for after component k."""
    if k < 32:
        return 1
    return 2 if k < 96 else 4


class RowWeights:
    def __init__(self, rows, index, options):
        self.row = rows[index]
        self.index = index
        self.options = options
        n = self.n = len(self.row.neighbours)
        self.M = [[0.0] * n for _ in range(n)]
        self.T = [0.0] * n
        self.precision = []
        for i in range(n):
            deviation = options.ring_deviation if i < self.row.ring else options.extra_deviation
            self.precision.append(self.row.precision[i] / (deviation * deviation))
        self.w = []
        self.misses = 0

    def observe_reference(self, positions):
        """positions: grid position of every row."""
        if self.n == 0:
            return
        own = positions[self.index]
        y = [[float(positions[k][a] - own[a]) for a in range(3)] for k in self.row.neighbours]
        spread = sum(x * x for d in y for x in d)
        inverse_noise = 1 / (0.25 + 0.002 * (spread / self.n))
        for i in range(self.n):
            for j in range(i + 1):
                product = y[i][0] * y[j][0] + y[i][1] * y[j][1] + y[i][2] * y[j][2]
                self.M[i][j] = self.M[i][j] + product * inverse_noise

    def observe(self, plane, noise, missed):
        """missed: whether the row had a residual."""
        scale = 1 / math.sqrt(noise)
        t = plane[self.index]
        to_one = self.options.sum_to_one
        y = [(plane[k] - t if to_one else plane[k]) * scale for k in self.row.neighbours]
        for i in range(self.n):
            M = self.M[i]
            for j in range(i + 1):
                M[j] = M[j] + y[i] * y[j]
            if not to_one:
                self.T[i] = self.T[i] + y[i] * (t * scale)
        self.misses += missed

    def forget(self):
        """fields.md section 6."""
        self.M = [[x * 0.5 for x in row] for row in self.M]

    def solve(self):
        n = self.n
        A = [list(row) for row in self.M]
        w = []
        for i in range(n):
            A[i][i] = A[i][i] + self.precision[i]
            w.append(self.row.prior[i] * self.precision[i] + self.T[i])
        inverse = factorise(A)
        substitute(A, inverse, w)
        if self.options.sum_to_one:
            b = [1.0] * n
            substitute(A, inverse, b)
            constrain(w, b)
        self.w = [f32(x) for x in w]
        self.misses = 0


def factorise(A):
    """A = L D L^T; returns the inverses of D."""
    n = len(A)
    diagonal = [0.0] * n
    inverse = [0.0] * n
    c = [0.0] * n
    for j in range(n):
        d = A[j][j]
        least = d * 2.0 ** -42
        for k in range(j):
            c[k] = A[j][k] * diagonal[k]
            d = d - A[j][k] * c[k]
        if d > least:
            diagonal[j] = d
            inverse[j] = 1 / d
        for i in range(j + 1, n):
            x = A[i][j]
            for k in range(j):
                x = x - A[i][k] * c[k]
            A[i][j] = x * inverse[j]
    return inverse


def substitute(A, inverse, x):
    n = len(x)
    for i in range(1, n):
        for k in range(i):
            x[i] = x[i] - A[i][k] * x[k]
    for i in range(n):
        x[i] = x[i] * inverse[i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            x[i] = x[i] - A[k][i] * x[k]


def constrain(w, b):
    sum_w = 0.0
    sum_b = 0.0
    for x in w:
        sum_w = sum_w + x
    for x in b:
        sum_b = sum_b + x
    f = (1 - sum_w) / sum_b if sum_b > 0 else 0.0
    for i in range(len(w)):
        w[i] = w[i] + b[i] * f
