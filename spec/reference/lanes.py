"""fast.md section 1: lane sections."""
from .bytes import Reader
from .entropy import ExpGolomb, RangeDecoder
from .errors import Corrupt, Truncated, require
from .raw_bits import RawBits

CLASSES = 20
SYMBOLS = 123
UNIT = 1024


def likely(f, before, s):
    """What f[s] is likely to be."""
    if s % 2 == 0:
        return (3 * f[s - 1] + before[s]) // 4
    same = (before[s] + before[s + 1]) // 2
    return same if s == 1 else ((f[s - 2] + f[s - 1]) // 2 + same) // 2


class LaneSection:
    def __init__(self, data, lanes):
        reader = Reader(data)
        try:
            table_bytes, raw_bytes = reader.u32(), reader.u32()
            tables, self.raw = reader.take(table_bytes), RawBits(reader.take(raw_bytes))
            self.state = [reader.u32() for _ in range(lanes)]
        except Truncated:
            raise Corrupt("a lane section is too short for its parts")
        self.words = reader.take(reader.remaining())
        require(len(self.words) % 2 == 0, "half a word is left")
        self.next_word = 0
        self.decode_tables(tables)

    def decode_tables(self, data):
        decoder = RangeDecoder(data)
        count, shift = ExpGolomb(), ExpGolomb()
        place = [[ExpGolomb() for _ in range(12)] for _ in range(2)]
        before = [0] * SYMBOLS
        self.frequency = []
        for _ in range(CLASSES):
            n = count.decode(decoder)
            require(n <= SYMBOLS, "too many symbols")
            if n == 0:
                self.frequency.append([])
                continue
            k = shift.decode(decoder)
            require(k <= 9, "frequencies are too coarse")
            f = [0] * SYMBOLS
            for s in range(1, n):
                context = (likely(f, before, s) + (1 << k) - 1) >> k
                g = place[s % 2][context.bit_length()].decode(decoder)
                decoder.check()
                f[s] = ((g - 1) << k) + 1 if g > 0 else 0
                require(sum(f) <= UNIT, "frequencies are too large")
            f[0] = UNIT - sum(f)
            self.frequency.append(f)
            before = f

    def decode(self, lane, which):
        """decode_lane: (integer, its symbol)."""
        x = self.state[lane]
        slot = x % UNIT
        start = 0
        frequency = self.frequency[which]
        require(frequency, "a class without frequencies")
        s = 0
        while start + frequency[s] <= slot:
            start += frequency[s]
            s += 1
        x = frequency[s] * (x // UNIT) + slot - start
        if x < 65536:
            x = x * 65536 + self.word()
        self.state[lane] = x
        b = (s + 1) // 2
        extra = 0 if b < 8 else (b - 8) // 2 + 2
        begin = b if b < 8 else (2 + (b - 8) % 2) << extra
        size = begin + self.raw.raw(extra)
        return (-size if s % 2 else size), s

    def word(self):
        at = 2 * self.next_word
        self.next_word += 1
        return self.words[at] + 256 * self.words[at + 1] if at < len(self.words) else 0

    def check(self):
        require(2 * self.next_word <= len(self.words), "a lane section is read past its end")
