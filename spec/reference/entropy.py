"""entropy.md: range decoder, adaptive bits, integers, mixed bits, interval decoder."""
import math

from .arithmetic import clamp
from .errors import require

EVEN = 32768


class CodeReader:
    """What both range decoders are: `size` bytes of code."""

    def __init__(self, data, size):
        self.data = data
        self.size = size
        self.position = 0
        self.code = 0
        self.range = (1 << 8 * size) - 1
        for _ in range(size):
            self.code = self.code * 256 + self.next_byte()

    def next_byte(self):
        self.position += 1
        return self.data[self.position - 1] if self.position <= len(self.data) else 0

    def shift(self):
        while self.range < 1 << 8 * (self.size - 1):
            self.code = (self.code * 256 + self.next_byte()) % (1 << 8 * self.size)
            self.range *= 256

    def decode_below(self, bound):
        if self.code < bound:
            bit = 1
            self.range = bound
        else:
            bit = 0
            self.code -= bound
            self.range -= bound
        self.shift()
        return bit

    def check(self):
        """Called wherever a section may be refused, and at its end."""
        require(self.position <= len(self.data) + self.size, "a section is read past its end")


class RangeDecoder(CodeReader):
    """Section 1."""

    def __init__(self, data):
        super().__init__(data, 4)

    def decode(self, p1):
        return self.decode_below((self.range * p1) >> 16)

    def decode_bits(self, count):
        v = 0
        for _ in range(count):
            v = 2 * v + self.decode(EVEN)
        return v


class IntervalDecoder(CodeReader):
    """Section 5."""

    def __init__(self, data):
        super().__init__(data, 8)

    def decode(self, p1):
        return self.decode_below((self.range >> 16) * p1)

    def decode_interval(self, whole, find):
        """What find(place) gives: (integer, below, size)."""
        unit = self.range // whole
        integer, below, size = find(min(self.code // unit, whole - 1))
        self.code = (self.code - unit * below) % (1 << 64)
        self.range = self.range - unit * below if below + size == whole else unit * size
        self.shift()
        return integer


class AdaptiveBit:
    """Section 2."""
    __slots__ = ("p", "n")

    def __init__(self):
        self.p = 1 << 21
        self.n = 0

    def p1(self):
        return clamp(self.p >> 6, 32, 65504)

    def update(self, bit, limit):
        target = (1 << 22) - 1 if bit else 0
        rate = (1 << 17) // (2 * self.n + 3)
        self.p += ((target - self.p) * rate) >> 16
        if self.n < limit:
            self.n += 1

    def decode(self, decoder, limit=255):
        bit = decoder.decode(self.p1())
        self.update(bit, limit)
        return bit


class ShortBit:
    """Section 2."""
    __slots__ = ("p", "n")

    def __init__(self):
        self.p = 1 << 15
        self.n = 0

    def p1(self):
        return clamp(self.p, 32, 65504)

    def update(self, bit, limit):
        target = 65535 if bit else 0
        rate = (1 << 16) // (2 * self.n + 3)
        self.p += ((target - self.p) * rate) >> 15
        if self.n < limit:
            self.n += 1


def adaptive_bits(count):
    return [AdaptiveBit() for _ in range(count)]


class ExpGolomb:
    """Section 3."""

    def __init__(self):
        self.length = adaptive_bits(30)
        self.top = [adaptive_bits(4) for _ in range(31)]

    def decode(self, decoder):
        n = 0
        while n < 30 and self.length[n].decode(decoder):
            n += 1
        v = 1
        for i in range(1, n + 1):
            bit = self.top[n][v].decode(decoder) if i <= 2 else decoder.decode(EVEN)
            v = 2 * v + bit
        return v - 1


class SignedInteger:
    """Section 3."""

    def __init__(self):
        self.size = ExpGolomb()
        self.negative = AdaptiveBit()

    def decode(self, decoder):
        size = self.size.decode(decoder)
        return -size if size != 0 and self.negative.decode(decoder) else size


def squash(x):
    """Section 4."""
    return clamp(math.floor(65536 / (1 + math.exp(-x / 256)) + 0.5), 1, 65535)


SQUASH = {x: squash(x) for x in range(-3072, 3073)}


def make_stretch():
    entries = []
    x = -2047
    for i in range(4096):
        while x < 2047 and SQUASH[x] < 16 * i + 8:
            x += 1
        entries.append(x)
    return entries


STRETCH = make_stretch()


class Mixer:
    """Section 4. table_sizes: entries of each table, which are of class `bit`."""

    def __init__(self, table_sizes, sets, limit, bit=AdaptiveBit):
        count = len(table_sizes)
        self.table = [[bit() for _ in range(size)] for size in table_sizes]
        self.weight = [[72089 // count] * count for _ in range(sets)]
        self.limit = limit

    def decode(self, decoder, entries, s):
        weight = self.weight[s]
        bits = [table[e] for table, e in zip(self.table, entries)]
        inputs = [STRETCH[bit.p1() >> 4] for bit in bits]
        dot = sum(w * x for w, x in zip(weight, inputs))
        mixed = SQUASH[clamp(dot >> 16, -3072, 3072)]
        bit = decoder.decode(mixed)
        error = (65535 if bit else 0) - mixed
        for i, x in enumerate(inputs):
            weight[i] += (x * error + 32768) >> 16
            bits[i].update(bit, self.limit)
        return bit
