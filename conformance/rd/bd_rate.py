"""Average difference of rate between two rate-distortion curves at equal error.

G. Bjontegaard, "Calculation of average PSNR differences between RD-curves", VCEG-M33, 2001; with monotone piecewise
cubic interpolation (F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984) in place of one cubic.
"""
import bisect
import math

LEAST_POINTS = 4


class MonotoneCubic:
    """Goes through points (x ascending, y), never beyond their values between two of them."""

    def __init__(self, x, y):
        self.x, self.y = list(x), list(y)
        self.slope = _slopes(self.x, self.y)

    def __call__(self, at):
        """Value at `at`, which lies within the points."""
        i = min(max(bisect.bisect_right(self.x, at) - 1, 0), len(self.x) - 2)
        h = self.x[i + 1] - self.x[i]
        s = (at - self.x[i]) / h
        return (self.y[i] * (1 + 2 * s) * (1 - s) ** 2 + self.slope[i] * h * s * (1 - s) ** 2
                + self.y[i + 1] * s * s * (3 - 2 * s) + self.slope[i + 1] * h * s * s * (s - 1))

    def integral(self, low, high):
        """From `low` to `high`, both within the points. Simpson's rule is exact for cubics."""
        knots = [low, *(x for x in self.x if low < x < high), high]
        return sum((b - a) / 6 * (self(a) + 4 * self((a + b) / 2) + self(b)) for a, b in zip(knots, knots[1:]))


def _slopes(x, y):
    h = [b - a for a, b in zip(x, x[1:])]
    d = [(b - a) / step for a, b, step in zip(y, y[1:], h)]
    if len(x) == 2:
        return [d[0], d[0]]
    inner = []
    for i in range(1, len(x) - 1):
        if d[i - 1] * d[i] <= 0:
            inner.append(0.0)
        else:
            w, v = 2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]
            inner.append((w + v) / (w / d[i - 1] + v / d[i]))
    return [_end_slope(h[0], h[1], d[0], d[1]), *inner, _end_slope(h[-1], h[-2], d[-1], d[-2])]


def _end_slope(h, next_h, d, next_d):
    """Three-point formula, held so that the curve stays monotone."""
    slope = ((2 * h + next_h) * d - h * next_d) / (h + next_h)
    if slope * d <= 0:
        return 0.0
    if d * next_d <= 0 and abs(slope) > 3 * abs(d):
        return 3 * d
    return slope


def curve(points):
    """Logarithm of the rate over the logarithm of the error, from (rate, error) pairs; None of too few."""
    usable = {math.log(error): math.log(rate) for rate, error in points if rate > 0 and 0 < error < math.inf}
    if len(usable) < LEAST_POINTS:
        return None
    x = sorted(usable)
    return MonotoneCubic(x, [usable[error] for error in x])


def bd_rate(anchor, other):
    """How much more rate `other` takes than `anchor` at equal error, in percent, over the errors that both reach.

    Both are (rate, error) pairs. None where a curve has too few points, or where they share less than an eighth of the
    logarithmic range of the anchor's errors.
    """
    a, b = curve(anchor), curve(other)
    if a is None or b is None:
        return None
    low, high = max(a.x[0], b.x[0]), min(a.x[-1], b.x[-1])
    if high - low < (a.x[-1] - a.x[0]) / 8:
        return None
    return 100 * (math.exp((b.integral(low, high) - a.integral(low, high)) / (high - low)) - 1)


def rate_at(points, error):
    """Rate at an error by the same interpolation; None outside of the points."""
    interpolated = curve(points)
    if interpolated is None or not interpolated.x[0] - 0.02 <= math.log(error) <= interpolated.x[-1] + 0.02:
        return None
    return math.exp(interpolated(min(max(math.log(error), interpolated.x[0]), interpolated.x[-1])))
