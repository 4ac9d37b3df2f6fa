"""lossless.md: groups that keep every bit. Reals are binary64 where nothing else is said."""
import math
import struct

from .arithmetic import clamp, f32, floor_log2, log2_5
from .bytes import LARGEST_F32
from .container import QUICK
from .entropy import AdaptiveBit, ExpGolomb, Mixer, RangeDecoder, adaptive_bits
from .errors import require
from .raw_bits import RawBits
from .weights import solve_system

FURTHEST = f32(1e37)
TABLES = (2048, 2048, 192, 256, 2048, 256)
STEPS = 17
LONGEST = 42


def bits_of(x):
    return struct.unpack("<I", struct.pack("<f", x))[0]


def float_of(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


class BinaryNumbers:
    """Section 1: all finite binary32 values."""

    def nearest(self, x):
        rank = bits_of(f32(min(abs(x), LARGEST_F32)))
        return with_sign(rank, math.copysign(1.0, x) < 0)

    def spacing(self, number):
        return 8 * (rank_of(number) >> 23)

    def value(self, number):
        rank = rank_of(number)
        require(rank < 0x7F800000, "a number that is not in the set")
        return signed(float_of(rank), number)


class Multiples:
    """Section 1: multiples of a step."""
    END = 1 << 39

    def __init__(self, step):
        self.step = step

    def nearest(self, x):
        n = x / self.step + 0.5
        return math.floor(clamp(n, 1 - self.END, self.END - 1))

    def spacing(self, number):
        return 0

    def value(self, number):
        x = f32(number * self.step)
        require(-self.END <= number < self.END and math.isfinite(x), "a number that is not in the set")
        return x


class Decimals:
    """Section 1: decimals of at most `digits` digits and `decimals` places."""

    def __init__(self, digits, decimals):
        self.digits, self.decimals = digits, decimals
        self.first = 10 ** digits
        self.later = 9 * 10 ** (digits - 1)
        self.count = self.first + (22 + decimals - digits) * self.later

    def decade(self, rank):
        return 0 if rank < self.first else (rank - self.first) // self.later + 1

    def value(self, number):
        rank = rank_of(number)
        require(rank < self.count, "a number that is not in the set")
        count = rank if rank < self.first else (rank - self.first) % self.later + self.first // 10
        return signed(f32(scale(float(count), self.decade(rank) - self.decimals)), number)

    def nearest(self, x):
        return with_sign(self.nearest_rank(abs(x)), math.copysign(1.0, x) < 0)

    def nearest_rank(self, x):
        p = self.decimals
        k = scale(x, p)
        while k + 0.5 >= self.first and p > self.digits - 22:
            p -= 1
            k = scale(x, p)
        count = math.floor(k + 0.5 if k + 0.5 < self.first else self.first - 0.5)
        if p == self.decimals:
            return count
        tenth = self.first // 10
        return self.first + (self.decimals - p - 1) * self.later + max(count, tenth) - tenth

    def spacing(self, number):
        return 213 * self.decade(rank_of(number)) // 8


class Levels:
    """Section 6: a grid of a frame."""

    def __init__(self, count, origin, step):
        self.count, self.origin, self.step = count, origin, step
        self.places = {}
        self.spacing_ = (struct.unpack("<Q", struct.pack("<d", step))[0] >> 49) - 6984

    def nearest(self, x):
        return math.floor(clamp((x - self.origin) / self.step + 0.5, 0, self.count - 1))

    def spacing(self, number):
        return self.spacing_

    def value(self, number):
        number %= self.count
        numbers = BinaryNumbers()
        return numbers.value(numbers.nearest(self.origin + number * self.step) + self.places.get(number, 0))


class FrameGrids:
    """Section 6: the grids of the frames along one axis."""

    def __init__(self):
        self.numbers = BinaryNumbers()
        self.same, self.gap, self.size, self.down = AdaptiveBit(), ExpGolomb(), ExpGolomb(), AdaptiveBit()

    def next(self, decoder, raw):
        if self.same.decode(decoder):
            return
        count = raw.raw(16)
        if count == 0:
            self.numbers = BinaryNumbers()
            return
        origin = decode_double(raw)
        require(abs(origin) <= LARGEST_F32, "an origin out of range")
        self.numbers = Levels(count, origin, decode_step(raw))
        self.decode_places(decoder)

    def decode_places(self, decoder):
        following = 0
        while True:
            following += self.gap.decode(decoder)
            decoder.check()
            if following >= self.numbers.count:
                require(following == self.numbers.count, "a correction of no level")
                return
            size = self.size.decode(decoder)
            require(size < 1 << 30, "a correction out of range")
            self.numbers.places[following] = -size - 1 if self.down.decode(decoder) else size + 1
            self.numbers.value(following)
            following += 1


def scale(x, p):
    return x / 10.0 ** -p if p < 0 else x * 10.0 ** p


def with_sign(rank, negative):
    return -1 - rank if negative else rank


def rank_of(number):
    return -1 - number if number < 0 else number


def signed(x, number):
    return -x if number < 0 else x


def decode_double(raw):
    low, high = raw.raw(32), raw.raw(32)
    return struct.unpack("<d", struct.pack("<II", low, high))[0]


def decode_step(raw):
    step = decode_double(raw)
    require(2.0 ** -1022 <= step <= LARGEST_F32, "a step out of range")
    return step


def decode_set(raw):
    digits = raw.raw(4)
    if digits == 15:
        return Multiples(decode_step(raw))
    if digits == 14:
        return None
    require(digits <= 9, "a set of too many digits")
    if digits == 0:
        return BinaryNumbers()
    decimals = raw.raw(5)
    require(decimals <= 22, "a set of too many decimals")
    return Decimals(digits, decimals)


class RowState:
    """Section 2: position, displacements and weights of a row."""

    def __init__(self, row, start, most):
        self.row = row
        self.x = list(start)
        self.now, self.before, self.older = [0.0] * 3, [0.0] * 3, [0.0] * 3
        near = min(len(row.neighbours), most)
        self.near = row.neighbours[:near]
        n = self.n = 2 + near
        self.prior = [0.0 if near else 0.8, 0.0] + row.prior[:near]
        self.m = [[0.0] * n for _ in range(n)]
        self.g = [0.0] * n
        self.e = 0.0
        self.squared_error = 0.0
        self.solve()

    def terms(self, rows, axis):
        return [self.before[axis], self.older[axis]] + [rows[i].now[axis] for i in self.near]

    def predict(self, rows, axis):
        prediction = 0.0
        for term, w in zip(self.terms(rows, axis), self.w):
            prediction = prediction + term * w
        return prediction + self.x[axis]

    def move(self, y, predictions):
        d = [y[a] - predictions[a] for a in range(3)]
        self.squared_error = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]
        self.now = [min(max(f32(y[a] - self.x[a]), -FURTHEST), FURTHEST) for a in range(3)]
        self.x = list(y)

    def learn(self, rows):
        kept = 507 / 512
        y = [self.terms(rows, axis) for axis in range(3)]
        d = self.now
        for i in range(self.n):
            for j in range(i + 1):
                total = self.m[i][j] * kept
                for axis in range(3):
                    total = total + y[axis][i] * y[axis][j]
                self.m[i][j] = self.m[j][i] = total
            total = self.g[i] * kept
            for axis in range(3):
                total = total + y[axis][i] * d[axis]
            self.g[i] = total
        self.e = self.e * 0.25 + self.squared_error * 0.75
        self.solve()

    def solve(self):
        trace = 0.0
        for i in range(self.n):
            trace = trace + self.m[i][i]
        ridge = max(self.e * 0.125, trace * 2.0 ** -34) + 1e-100
        A = [list(row) for row in self.m]
        w = []
        for i in range(self.n):
            A[i][i] = A[i][i] + ridge
            w.append(self.g[i] + ridge * self.prior[i])
        solve_system(A, [w])
        self.w = [f32(x) if -64 < x < 64 else 0.0 for x in w]

    def jump(self, position):
        self.x = list(position)
        self.now, self.before, self.older = [0.0] * 3, [0.0] * 3, [0.0] * 3


class LosslessGroup:
    def __init__(self, group, rows, positions, reference):
        """positions: grid position of every row."""
        self.decoder = RangeDecoder(group.differences)
        self.raw = RawBits(group.raw)
        self.graph = rows
        self.quick = group.flags & QUICK != 0
        count = len(rows)
        self.rows = []
        for row, p in zip(rows, positions):
            start = [reference.origin[a] + p[a] * reference.grid_step for a in range(3)]
            self.rows.append(RowState(row, [f32(min(max(x, -LARGEST_F32), LARGEST_F32)) for x in start],
                                      6 if self.quick else 14))
        self.repeats, self.same, self.distance = adaptive_bits(2), AdaptiveBit(), ExpGolomb()
        self.last = self.known = 0
        self.still = adaptive_bits(72)
        self.mixer = Mixer([contexts * STEPS for contexts in TABLES], 3 * STEPS, 250)
        self.length = [adaptive_bits(STEPS) for _ in range(160)]
        self.sign_bit = adaptive_bits(27)
        self.place = [[adaptive_bits(8) for _ in range(5)] for _ in range(8)]
        self.quiet = [0] * count
        self.sign = [[0] * 3 for _ in range(count)]
        self.size = [[1120] * 3 for _ in range(count)]
        self.older_size = [[1120] * 3 for _ in range(count)]
        self.running = [17920] * 3
        self.frames = []
        self.decode(group)

    def decode(self, group):
        self.sets = [decode_set(self.raw) for _ in range(3)]
        self.grids = [FrameGrids() if numbers is None else None for numbers in self.sets]
        self.coded = 0
        for t in range(group.frame_count):
            distance = self.decode_distance()
            self.decoder.check()
            if distance > 0:
                require(distance <= t, "a copy of a frame before the group")
                self.frames.append(self.frames[t - distance])
                for row, position in zip(self.rows, self.frames[t]):
                    row.jump(position)
            else:
                self.decode_frame()
                self.coded += 1
                require(self.coded <= group.stored_count, "more coded frames than stored_count")
        require(self.coded == group.stored_count, "fewer coded frames than stored_count")
        self.decoder.check()
        self.raw.check_end()

    def position(self, row, t):
        return self.frames[t][row]

    def decode_distance(self):
        if not self.repeats[1 if self.last > 0 else 0].decode(self.decoder):
            self.last = 0
            return 0
        if self.known == 0 or not self.same.decode(self.decoder):
            self.known = self.distance.decode(self.decoder) + 1
        self.last = self.known
        return self.known

    def decode_frame(self):
        """Section 3."""
        for a, grids in enumerate(self.grids):
            if grids is not None:
                grids.next(self.decoder, self.raw)
                self.sets[a] = grids.numbers
        for r, row in enumerate(self.rows):
            predictions = [row.predict(self.rows, a) for a in range(3)]
            if self.still[self.still_context(r)].decode(self.decoder, 1000):
                y = list(row.x)
                self.quiet[r] = min(self.quiet[r] + 1, 7)
            else:
                self.quiet[r] = 0
                y = [self.decode_coordinate(r, a, predictions[a]) for a in range(3)]
            row.move(y, predictions)
            self.decoder.check()
        self.frames.append([tuple(row.x) for row in self.rows])
        if self.coded > 0:
            if not self.quick or self.coded < 8 or self.coded % 4 == 0:
                for row in self.rows:
                    row.learn(self.rows)
            for row in self.rows:
                row.older = row.before
                row.before = row.now

    def still_context(self, r):
        neighbours = self.graph[r].neighbours

        def state(i):
            return 2 if i >= len(neighbours) else 1 if self.quiet[neighbours[i]] > 0 else 0

        return (self.quiet[r] * 3 + state(0)) * 3 + state(1)

    def decode_coordinate(self, r, a, prediction):
        numbers = self.sets[a]
        guess = numbers.nearest(prediction)
        unit = numbers.spacing(guess)
        contexts = LengthContexts(self, r, a, unit)
        length = self.decode_length(contexts)
        n = 0
        if length == LONGEST:
            y = float_of(self.raw.raw(32))
            require(math.isfinite(y), "a position is not finite")
        else:
            n = self.decode_difference(r, a, length, contexts.expected)
            y = numbers.value(guess + n)
        self.older_size[r][a] = self.size[r][a]
        self.size[r][a] = log2_5(abs(n) + 1) // 4 + unit
        self.sign[r][a] = (n > 0) - (n < 0)
        self.running[a] = self.running[a] + self.size[r][a] - self.running[a] // 16
        return y

    def decode_length(self, contexts):
        """Section 5."""
        def more(step):
            if self.quick:
                return self.length[min(contexts.expected // 2, 159)][step].decode(self.decoder, 500)
            return self.mixer.decode(self.decoder, contexts.entries(step), step * 3 + contexts.axis)

        length = clamp((contexts.expected + 4) // 8, 1, 41)
        step = 8
        if more(step):
            while length < LONGEST:
                step = min(step + 1, 16)
                if not more(step):
                    break
                length += 1
            return length
        while True:
            length -= 1
            if length == 0:
                return 0
            step = max(step, 1) - 1
            if more(step):
                return length

    def decode_difference(self, r, a, length, expected):
        if length == 0:
            return 0
        if self.quick:
            return self.decode_raw_difference(length)
        neighbours = self.graph[r].neighbours

        def s(i):
            return self.sign[neighbours[i]][a] if i < len(neighbours) else 0

        bit = self.sign_bit[(self.sign[r][a] + 1) * 9 + (s(0) + 1) * 3 + s(1) + 1]
        negative = bit.decode(self.decoder, 250)
        shape = clamp((expected + 4) // 8 - length + 4, 0, 7)
        node = 1
        left = length - 1
        while left > 0 and node < 8:
            node = 2 * node + self.place[shape][min(length, 4)][node].decode(self.decoder, 1000)
            left -= 1
        size = node
        while left > 0:
            n = min(left, 24)
            left -= n
            size = (size << n) + self.raw.raw(n)
        return -size if negative else size

    def decode_raw_difference(self, length):
        v, left = 0, length
        while left > 0:
            n = min(left, 24)
            left -= n
            v = (v << n) + self.raw.raw(n)
        return -v if v >= 1 << (length - 1) else v + (1 << (length - 1))


class LengthContexts:
    """Section 4."""

    def __init__(self, group, r, a, unit):
        neighbours = group.graph[r].neighbours
        self.axis = a
        before = group.size[r][a] - unit
        older = group.older_size[r][a] - unit
        running = group.running[a] // 16
        m = min(len(neighbours), 4)
        ring = (sum(group.size[i][a] for i in neighbours[:m]) // m if m else running) - unit
        nearest = (group.size[neighbours[0]][a] if m else group.size[r][a]) - unit
        axis_before = (group.size[r][a - 1] if a > 0 else running) - unit
        if group.coded == 0:
            expected = ring
        elif a > 0:
            expected = 4 * before + 2 * older + 6 * ring + 4 * axis_before
            expected = max(0, expected) // 16
        else:
            expected = 4 * before + 2 * older + 6 * ring + axis_before
            expected = max(0, expected) // 13
        self.expected = expected = max(0, expected)

        def relative(s):
            return clamp((s - expected + 34) // 4 if s - expected + 34 >= 0 else 0, 0, 15)

        phase = expected % 8
        coarseness = min(7, floor_log2(max(1, len(group.graph) // (r + 1))))
        self.tables = (
            (relative(before) * 16 + relative(ring)) * 8 + phase,
            (relative(axis_before) * 16 + relative(before)) * 8 + phase,
            (coarseness * 8 + phase) * 3 + a,
            min(expected, 255),
            (relative(ring) * 16 + relative(axis_before)) * 8 + phase,
            relative(older) * 16 + relative(nearest),
        )

    def entries(self, step):
        return [context * STEPS + step for context in self.tables]
