"""prediction.md section 5: weights of a row. All in binary64."""
import math

from .arithmetic import f32


class WeightOptions:
    def __init__(self, ring_deviation, extra_deviation, sum_to_one):
        self.ring_deviation = ring_deviation
        self.extra_deviation = extra_deviation
        self.sum_to_one = sum_to_one


COEFFICIENT_WEIGHTS = WeightOptions(1.4, 0.9, True)
WEAK_PRIOR_WEIGHTS = WeightOptions(2.4, 1.5, True)
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
            self.precision.append(self.row.precision[i] * (1 / (deviation * deviation)))
        self.w = []
        self.misses = 0
        self.list = []

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

    def note(self, plane, noise, missed):
        """missed: whether the row had a residual."""
        self.list.append((plane, noise))
        self.misses += missed

    def observe_list(self):
        for plane, noise in self.list:
            self.observe(plane, noise)
        self.list = []

    def end_list(self):
        if self.misses > 0:
            self.observe_list()
        self.list = []

    def observe(self, plane, noise):
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

    def fade(self):
        """fields.md section 6."""
        self.end_list()
        self.M = [[x * 0.5 for x in row] for row in self.M]

    def solve(self):
        self.observe_list()
        n = self.n
        A = [list(row) for row in self.M]
        w = []
        for i in range(n):
            A[i][i] = A[i][i] + self.precision[i]
            w.append(self.row.prior[i] * self.precision[i] + self.T[i])
        if self.options.sum_to_one:
            b = [1.0] * n
            solve_system(A, [w, b])
            constrain(w, b)
        else:
            solve_system(A, [w])
        self.w = [f32(x) for x in w]
        self.misses = 0


def solve_system(A, sides):
    """A x = b for every right side b, which x takes the place of; changes A."""
    factorise(A, sides)
    for x in sides:
        for k in range(len(A) - 1, 0, -1):
            for i in range(k):
                x[i] = x[i] - A[k][i] * x[k]


def factorise(A, sides):
    n = len(A)
    rows = A + sides
    diagonal = [0.0] * n
    c = [0.0] * n
    for j in range(n):
        d = A[j][j]
        least = d * 2.0 ** -42
        for k in range(j):
            c[k] = A[j][k] * diagonal[k]
            d = d - A[j][k] * c[k]
        inverse = 0.0
        if d > least:
            diagonal[j] = d
            inverse = 1 / d
        for row in rows[j + 1:]:
            x = row[j]
            for k in range(j):
                x = x - row[k] * c[k]
            row[j] = x * inverse


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
