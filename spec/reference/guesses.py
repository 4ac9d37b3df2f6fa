"""reference_mesh.md section 2.1: mixture of guesses."""
from .arithmetic import clamp, floor_log2

SHARE = 4096
MOST_GUESSES = 256


class ErrorModel:
    """How large errors are of one kind of guess."""

    def __init__(self):
        weights = []
        w = 256
        for b in range(144):
            if b >= 8:
                w = max(w - w // 16, 1)
            weights.append(w)
        self.weights = [weights, list(weights)]  # of errors >= 0, of errors < 0
        self.seen = 4 * SHARE
        self.prepare()

    def prepare(self):
        """What W needs of the weights as they are now."""
        self.scale = (1 << 32) // self.seen
        self.before = []
        for weights in self.weights:
            sums = []
            total = 0
            for w in weights:
                sums.append(total)
                total += w
            self.before.append(sums)

    def weight_to(self, error):
        """W."""
        side = 1 if error < 0 else 0
        size = abs(error)
        b, start, m = bucket(size)
        inside = ((size - start) * 256 * self.weights[side][b]) >> m
        w = (256 * self.before[side][b] + inside) * self.scale
        return -w if error < 0 else w

    def learn(self, error, share, memory):
        side = 1 if error < 0 else 0
        size = -error - 1 if error < 0 else error
        self.weights[side][bucket(size)[0]] += share
        self.seen += SHARE
        if self.seen > SHARE * memory:
            self.seen //= 2
            self.weights = [[w - w // 2 for w in weights] for weights in self.weights]
        self.prepare()


def bucket(size):
    """(bucket, its start, m) of an error's size; the bucket is 2^m wide."""
    if size < 128:
        return size // 16, size // 16 * 16, 4
    k = floor_log2(size)
    m = k - 2
    return 8 + 4 * (k - 7) + (size >> m) - 4, size >> m << m, m


class Guess:
    def __init__(self, kind, place, scale):
        self.kind = kind
        self.place = place
        self.gain = (1 << 23) // scale

    def error(self, x256):
        return ((x256 - self.place) * self.gain) >> 16


class GuessMixture:
    def __init__(self, kinds, memory):
        self.models = [ErrorModel() for _ in range(kinds)]
        self.memory = memory

    def decode(self, decoder, guesses, count):
        """A value of 0 .. count-1."""
        guesses = guesses[:MOST_GUESSES]
        known = {}  # W of all guesses, by bound

        def weights(x):
            if x not in known:
                known[x] = [self.models[g.kind].weight_to(g.error(256 * x)) for g in guesses]
            return known[x]

        def s(x):
            return 256 * x + sum(weights(x))

        def find(place):
            first, last = 0, count
            x = clamp(guesses[0].place // 256, 1, count) if guesses else 1  # a likely bound, then halves
            step = 1
            while last - first > 1:
                if s(x) - s(0) <= place:
                    first, x = x, x + step
                else:
                    last, x = x, x - step
                step *= 2
                if not first < x < last:
                    x = first + (last - first) // 2
            return first, s(first) - s(0), s(first + 1) - s(first)

        v = decoder.decode_interval(s(count) - s(0), find)
        everything = s(v + 1) - s(v)
        shares = [(w - u) * SHARE // everything for u, w in zip(weights(v), weights(v + 1))]
        for g, share in zip(guesses, shares):
            self.models[g.kind].learn(g.error(256 * v + 128), share, self.memory)
        return v
