"""fast.md section 1: lane sections."""
from .bytes import Reader
from .entropy import ExpGolomb, RangeDecoder
from .errors import Corrupt, Truncated, require
from .raw_bits import RawBits

CLASSES = 20
SYMBOLS = 123
UNIT = 1024


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
        count = ExpGolomb()
        f = [ExpGolomb() for _ in range(24)]
        self.frequency = []
        for _ in range(CLASSES):
            n = count.decode(decoder)
            require(n <= SYMBOLS, "too many symbols")
            others = [f[min(s, 23)].decode(decoder) for s in range(1, n)]
            require(sum(others) <= UNIT, "frequencies are too large")
            decoder.check()
            self.frequency.append([UNIT - sum(others)] + others if n > 0 else [])

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
