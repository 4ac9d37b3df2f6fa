"""connectivity.md: triangles and their points, by an edgebreaker."""
from .bytes import Reader
from .errors import Corrupt, Truncated, require

CLOSE, SPLIT, LEFT, RIGHT, END = range(5)
STANDARD, VALENCE = 0, 2
NONE = -1


def decode_connectivity(section, most):
    """(number of points, triangles as a flat list of points); `most` triangles."""
    if not section:
        return 0, []
    try:
        return decode_section(Reader(section), most)
    except Truncated:
        raise Corrupt("the connectivity ends early") from None


def decode_section(reader, most):
    """Section 1."""
    traversal = reader.u8("traversal", 0, 2)
    vertices, triangles = reader.uv(), reader.uv("triangles", 1, 1 << 29)
    reader.u8("attribute tables", 0, 0)
    symbols = reader.uv("symbols", 1, triangles)
    splits = reader.uv("splits", 0, symbols)
    require(traversal != 1, "unknown traversal")
    require(0 < vertices <= 3 * symbols - splits and triangles <= symbols + symbols // 3, "impossible counts")
    require(triangles <= most, "more triangles than the bytes can hold")
    waiting = read_waiting(reader, symbols, splits)
    if traversal == STANDARD:
        source = Bits(reader.take(reader.uv()))
        starts = BitCode(reader)
    else:
        starts = BitCode(reader)
        source = Lists(reader, symbols - 1)
    require(reader.remaining() == 0, "bytes behind the connectivity")
    surface = Surface(triangles, vertices + splits)
    active = build(surface, symbols, source, waiting)
    finish(surface, active, starts)
    require(source.at_end() and starts.at_end(), "symbols or starts are left")
    require(len(surface.points) == 3 * triangles and len(surface.became) == splits, "other triangles than announced")
    require(len(surface.degree) == vertices + splits, "other points than announced")
    points = surface.numbered()
    for t in range(0, len(points), 3):
        require(len(set(points[t:t + 3])) == 3, "a triangle has a point twice")
    return vertices, points


def read_waiting(reader, symbols, splits):
    """Section 1: edges by the split they wait for."""
    source, found = 0, []
    for _ in range(reader.uv("waiting", 0, splits)):
        source += reader.uv()
        require(source < symbols, "an edge waits beyond the symbols")
        distance = reader.uv("distance", 1, source)
        found.append((symbols - 1 - source, distance))
    bits = Bits(reader.take((len(found) + 7) // 8))
    waiting = {}
    for s, distance in found:
        edge = 3 * s + (1 if bits.take(1) else 2)
        require(s + distance not in waiting, "two edges wait for one split")
        waiting[s + distance] = edge
    require(bits.at_end(), "bits are left")
    return waiting


class Bits:
    """Section 3.1 as well."""

    def __init__(self, data):
        self.data = data
        self.position = 0

    def take(self, count):
        value = 0
        for i in range(count):
            require(self.position < 8 * len(self.data), "bits are read past their end")
            value |= (self.data[self.position // 8] >> self.position % 8 & 1) << i
            self.position += 1
        return value

    def at_end(self):
        used = (self.position + 7) // 8
        return used == len(self.data) and (self.position % 8 == 0 or self.data[-1] >> self.position % 8 == 0)

    def next(self, _):
        return 1 + self.take(2) if self.take(1) else CLOSE


class Code:
    """Section 2."""

    def __init__(self, data, base, most):
        require(data, "an empty code")
        count = (data[-1] >> 6) + 1
        require(count <= min(most, len(data)), "a code without its first state")
        value = int.from_bytes(data[-count:], "little")
        self.state = base + value % (1 << (8 * count - 2))
        require(self.state < 256 * base, "the first state is too large")
        self.base = base
        self.data = data[:-count]

    def fill(self):
        while self.state < self.base:
            require(self.data, "a code is read past its end")
            self.state = self.state * 256 + self.data[-1]
            self.data = self.data[:-1]

    def at_end(self):
        self.fill()
        return self.state == self.base and not self.data


class BitCode(Code):
    """Section 2.1."""

    def __init__(self, reader):
        self.zeros = reader.u8("zeros", 1, 255)
        super().__init__(reader.take(reader.uv()), 4096, 3)

    def next(self):
        self.fill()
        ones = 256 - self.zeros
        high, low = divmod(self.state, 256)
        bit = 1 if low < ones else 0
        self.state = high * ones + low if bit else high * self.zeros + low - ones
        return bit


class SymbolCode(Code):
    """Section 2.2."""

    def __init__(self, reader, allowed):
        count = reader.uv("symbols", 1, allowed)
        self.probability = []
        while len(self.probability) < count:
            b = reader.u8("probability", 0, 255)
            if b % 4 == 3:
                self.probability += [0] * (b // 4 + 1)
            else:
                self.probability.append(b // 4 + 64 * int.from_bytes(reader.take(b % 4), "little"))
        require(len(self.probability) == count and sum(self.probability) == 4096, "impossible probabilities")
        super().__init__(reader.take(reader.uv()), 16384, 4)

    def next(self):
        self.fill()
        high, low = divmod(self.state, 4096)
        symbol = 0
        while low >= self.probability[symbol]:
            low -= self.probability[symbol]
            symbol += 1
        self.state = high * self.probability[symbol] + low
        return symbol


class Lists:
    """Section 3.2."""

    def __init__(self, reader, count):
        self.lists = []
        for _ in range(6):
            size = reader.uv("list size", 0, count)
            count -= size
            self.lists.append(read_list(reader, size) if size else [])
        require(count == 0, "symbols are missing")
        require(all(symbol <= END for symbols in self.lists for symbol in symbols), "no such symbol")

    def next(self, degree):
        if degree == 0:
            return END
        symbols = self.lists[min(max(degree, 2), 7) - 2]
        require(symbols, "no symbol is left")
        return symbols.pop()

    def at_end(self):
        return not any(self.lists)


def read_list(reader, size):
    if reader.u8("kind", 0, 1) == 0:
        code = SymbolCode(reader, 4)
        lengths = [code.next() for _ in range(size)]
        bits = Bits(reader.take((sum(lengths) + 7) // 8))
        symbols = [bits.take(length) for length in lengths]
        require(bits.at_end(), "bits are left")
    else:
        reader.u8("bits", 1, 8)
        code = SymbolCode(reader, 5)
        symbols = [code.next() for _ in range(size)]
    require(code.at_end(), "a code is not read to its end")
    return symbols


def after(c):
    return c - 2 if c % 3 == 2 else c + 1


def before(c):
    return c + 2 if c % 3 == 0 else c - 1


class Surface:
    """Section 4."""

    def __init__(self, triangles, points):
        self.most_corners = 3 * triangles
        self.most_points = points
        self.points = []  # of each corner
        self.corners = []  # of each point
        self.joined = []  # of each edge, or NONE
        self.outer = []
        self.degree = []
        self.became = []

    def start(self, edge):
        return self.points[after(edge)]

    def end(self, edge):
        return self.points[before(edge)]

    def follow(self, a):
        return after(self.outer[self.start(a)])

    def new_point(self, outer):
        require(len(self.outer) < self.most_points, "too many points")
        self.outer.append(outer)
        self.degree.append(2)
        self.corners.append([])
        return len(self.outer) - 1

    def add(self, *points):
        c = len(self.points)
        require(c < self.most_corners, "too many triangles")
        self.points += points
        self.joined += [NONE] * 3
        for i, p in enumerate(points):
            self.corners[p].append(c + i)
        return c

    def join(self, a, b):
        require(a != b and self.joined[a] == NONE and self.joined[b] == NONE, "an edge is not free")
        self.joined[a], self.joined[b] = b, a

    def add_end(self):
        c = len(self.points)
        return self.add(*[self.new_point(c + i) for i in range(3)])

    def add_right(self, a):
        s, e, c = self.start(a), self.end(a), len(self.points)
        self.add(e, s, self.new_point(c + 2))
        self.join(a, c + 2)
        self.outer[e] = c
        return self.grown(s, e, c)

    def add_left(self, a):
        s, e, c = self.start(a), self.end(a), len(self.points)
        self.add(s, self.new_point(c + 1), e)
        self.join(a, c + 1)
        self.outer[e] = c + 2
        return self.grown(s, e, c)

    def add_close(self, a):
        b = self.follow(a)
        s, e = self.start(b), self.end(a)
        c = self.add(self.start(a), s, e)
        self.join(a, c + 1)
        self.join(b, c + 2)
        self.outer[e] = c + 2
        return self.grown(s, e, c)

    def add_split(self, a, b):
        k, g, s, e = self.end(a), self.start(b), self.start(a), self.end(b)
        require(k != g, "a split joins a point to itself")
        c = self.add(k, s, e)
        self.join(a, c + 2)
        self.join(b, c + 1)
        self.outer[e] = c + 2
        self.outer[k] = self.outer[g]
        self.degree[k] += self.degree[g]
        for corner in self.corners[g]:
            self.points[corner] = k
        self.corners[k] += self.corners[g]
        self.corners[g] = []
        self.became.append(g)
        return self.grown(self.points[c + 1], self.points[c + 2], c)

    def grown(self, s, e, c):
        self.degree[s] += 1
        self.degree[e] += 1
        return c

    def add_start(self, a):
        b = self.follow(a)
        d = self.follow(b)
        require(self.start(d) == self.end(a), "a hole of other than three edges")
        c = self.add(self.start(b), self.start(d), self.start(a))
        for i, edge in enumerate((a, b, d)):
            self.join(edge, c + i)

    def numbered(self):
        has = list(range(len(self.degree)))  # the point of each number
        for g in self.became:
            has[g] = NONE
        n = len(has)
        for g in self.became:
            while has[n - 1] == NONE:
                n -= 1
            if g < n:
                has[g], has[n - 1] = has[n - 1], NONE
        number = {point: i for i, point in enumerate(has)}
        return [number[p] for p in self.points]


def build(surface, symbols, source, waiting):
    """Section 4: the edges active behind the last symbol."""
    active = []

    def pop():
        require(active, "no edge is active")
        return active.pop()

    for i in range(symbols):
        symbol = source.next(surface.degree[surface.start(active[-1])] if active else 0)
        if symbol == END:
            edge = surface.add_end()
        elif symbol == SPLIT:
            b = pop()
            a = waiting.pop(i) if i in waiting else pop()
            edge = surface.add_split(a, b)
        else:
            add = {CLOSE: surface.add_close, LEFT: surface.add_left, RIGHT: surface.add_right}[symbol]
            edge = add(pop())
        active.append(edge)
    require(not waiting, "an edge waits for ever")
    return active


def finish(surface, active, starts):
    while active:
        a = active.pop()
        if starts.next():
            surface.add_start(a)
        else:
            require(surface.joined[a] == NONE, "an edge is not free")
