"""corrections.md: coordinates corrected after synthesis."""
import math

from .arithmetic import clamp, f32, log2_5
from .entropy import Mixer, RangeDecoder, adaptive_bits
from .errors import require
from .lossless import float_of

SOME_TABLES = (216, 192, 196, 216, 196, 336)
NEGATIVE_TABLES = (125, 125, 25)
NEAR_CLASS = [0, 1, 1, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5] + [6] * 8


def follow(rate, hit, shift):
    return rate + ((hit - rate) >> shift) if hit > rate else rate - ((rate - hit) >> shift)


def near_class(m):
    return NEAR_CLASS[m] if m < len(NEAR_CLASS) else 7


def rate_class(r):
    return min(13, (log2_5(r + 48) - 160) // 24)


def c(x):
    return clamp(x, -2, 2) + 2


class Value:
    """A correction that replaces the coordinate."""

    def __init__(self, x):
        self.x = x


class Corrections:
    """correction(row, t, axis): a number of steps, a Value, or None."""

    def __init__(self, group, rows):
        self.decoder = RangeDecoder(group.corrections)
        self.rows = rows
        self.step = group.correction_step
        self.frames = group.frame_count
        self.of_row = []  # {(t, axis): correction} of every row so far
        self.density = []
        self.frame_rate = [[1024] * 3 for _ in range(self.frames)]
        self.active = adaptive_bits(10)
        self.lengths = [adaptive_bits(53) for _ in range(4)]
        self.some = Mixer(SOME_TABLES, 3, 500)
        self.negative = Mixer(NEGATIVE_TABLES, 1, 500)
        if group.correction_count > 0:
            self.decode_rows()
            self.decoder.check()
        require(sum(len(found) for found in self.of_row) == group.correction_count, "wrong number of corrections")

    def decode_rows(self):
        for r in range(len(self.rows)):
            self.begin(r)
            if self.active[self.active_context].decode(self.decoder):
                for t in range(self.frames):
                    for axis in range(3):
                        correction = self.decode_one(t, axis)
                        if correction is not None:
                            self.own[t, axis] = correction
                        self.note(t, axis)
                    self.decoder.check()
            self.density.append((len(self.own) << 16) // (3 * self.frames))

    def s_of(self, r, t, axis):
        """s(row, t, axis) of section 1."""
        correction = self.of_row[r].get((t, axis), 0)
        return 2 if isinstance(correction, Value) else clamp(correction, -2, 2)

    def s(self, t, axis):
        return self.s_of(-1, t, axis)

    def begin(self, r):
        row = self.rows[r]
        self.shares = [(n, 2 if i < row.ring else 1) for i, n in enumerate(row.neighbours)]
        weight = sum(share for _, share in self.shares)
        active = sum(share for n, share in self.shares if self.of_row[n])
        mean = sum(share * self.density[n] for n, share in self.shares) // weight if weight else 0
        self.reciprocal = (1 << 20) // weight if weight else 0
        self.near_density = rate_class(mean)
        self.row_rate = max(mean, 256)
        share = (4 * active + weight - 1) // weight if weight else 2
        self.active_context = 2 * share + (1 if r > 0 and self.of_row[-1] else 0)
        self.own = {}
        self.recent = (0, 0)
        self.of_row.append(self.own)

    def size(self, t, axis):
        return sum(share * abs(self.s_of(n, t, axis)) for n, share in self.shares)

    def sum(self, t, axis):
        return sum(share * self.s_of(n, t, axis) for n, share in self.shares)

    def near(self, t, axis):
        return near_class((self.size(t, axis) * self.reciprocal) >> 16)

    def note(self, t, axis):
        hit = 65535 if (t, axis) in self.own else 0
        self.frame_rate[t][axis] = follow(self.frame_rate[t][axis], hit, 6)
        self.row_rate = follow(self.row_rate, hit, 5)
        self.recent = (abs(self.s(t, axis)), self.recent[0])

    def decode_one(self, t, axis):
        """Section 2."""
        if not self.some.decode(self.decoder, *self.some_contexts(t, axis)):
            return None
        context = min(3, abs(self.s(t - 1, axis)) + (1 if self.size(t, axis) > 2 else 0))
        length = 0
        while length < 53 and self.lengths[context][length].decode(self.decoder):
            length += 1
        if length == 53:
            value = float_of(self.decoder.decode_bits(32))
            require(math.isfinite(value), "a corrected value is not finite")
            return Value(value)
        steps = (1 << length) + self.decoder.decode_bits(length)
        return -steps if self.negative.decode(self.decoder, self.negative_entries(t, axis), 0) else steps

    def some_contexts(self, t, axis):
        before, earlier = abs(self.s(t - 1, axis)), abs(self.s(t - 2, axis))
        other, another = self.recent
        near = self.near(t, axis)
        around = (self.near(t - 1, axis) + self.near(t + 1, axis) + 1) // 2
        beside = (sum(self.near(t, b) for b in range(3) if b != axis) + 1) // 2
        frame, own = rate_class(self.frame_rate[t][axis]), rate_class(self.row_rate)
        entries = (
            ((before * 3 + earlier) * 8 + near) * 3 + axis,
            (near * 8 + around) * 3 + before,
            frame * 14 + own,
            ((other * 3 + another) * 8 + beside) * 3 + before,
            own * 14 + self.near_density,
            (frame * 8 + near) * 3 + before,
        )
        return entries, min(2, before + (1 if near > 0 else 0))

    def negative_entries(self, t, axis):
        before, here = c(self.s(t - 1, axis)), c(self.sum(t, axis))
        both = self.sum(t - 1, axis) + self.sum(t + 1, axis)
        both = both // 2 if both >= 0 else -(-both // 2)
        return ((before * 5 + c(self.s(t - 2, axis))) * 5 + here, (here * 5 + c(both)) * 5 + before, before * 5 + here)

    def apply(self, position, row, t):
        """The position of a row and time, corrected."""
        if not self.of_row:
            return position
        corrected = list(position)
        for axis in range(3):
            correction = self.of_row[row].get((t, axis))
            if isinstance(correction, Value):
                corrected[axis] = correction.x
            elif correction is not None:
                corrected[axis] = f32(position[axis] + correction * self.step)
        return corrected
