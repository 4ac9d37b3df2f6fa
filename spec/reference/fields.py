"""fields.md: the coefficients and the basis of a group."""
import math
from dataclasses import dataclass

from .arithmetic import f32, log2_5, product32, sum32
from .container import MAIN, THESIS
from .entropy import EVEN, Mixer, RangeDecoder, ShortBit, adaptive_bits
from .errors import require
from .surface import STEPS
from .weights import BASIS_WEIGHTS, COEFFICIENT_WEIGHTS, WEAK_PRIOR_WEIGHTS, RowWeights, WeightOptions, misses_to_solve


@dataclass
class FieldOptions:
    weights: WeightOptions
    predict: bool
    adapt: bool
    noise_share: float = 0.0
    noise_floor: float = 0.0


COEFFICIENTS = {
    MAIN: FieldOptions(COEFFICIENT_WEIGHTS, True, True, 2.2, 0.2),
    THESIS: FieldOptions(COEFFICIENT_WEIGHTS, False, False),
}
WEAK_PRIOR_COEFFICIENTS = FieldOptions(WEAK_PRIOR_WEIGHTS, True, True, 2.2, 0.2)
BASIS = FieldOptions(BASIS_WEIGHTS, True, True, 0.5, 0.05)

TABLE_CONTEXTS = (144, 24, 96, 144)
BINS = 24
NODES = 48
UNSURE = 10


def classify(x, c, s):
    """class(x, c, s) of section 3."""
    return min(c - 1, (log2_5(256 + 4 * x) - 256) * s // 128)


@dataclass
class Surroundings:
    """Section 3."""
    ring_mean: int
    extra_mean: int
    recent: int
    history: int
    last: int
    step: int

    def expected(self):
        return 3 * self.ring_mean + 2 * self.extra_mean + 3 * self.recent + 8 * self.history

    def calm_class(self):
        """None where the row is not calm."""
        c = self.expected() // (self.step >> 8)
        return c if c < 4 else None


class Contexts:
    """Section 3, second half."""

    def __init__(self, s):
        def relative(x):
            return (x << 16) // s.step

        ring = relative(s.ring_mean)
        recent = relative(s.recent)
        expected = relative(s.expected() // 16)
        self.tables = (
            classify(ring, 12, 6) * 12 + classify(relative(s.history), 12, 6),
            classify(expected, 24, 8),
            classify(recent, 8, 4) * 12 + classify(relative(s.last), 12, 6),
            classify(relative(s.extra_mean), 12, 6) * 12 + classify((ring + recent) // 2, 12, 6),
        )
        self.escape_class = classify(expected, 8, 3)
        self.unsure = self.tables[1] >= UNSURE


class ResidualDecoder:
    """Section 4. before: that of the group that this one continues, section 6."""

    def __init__(self, data, before=None):
        self.decoder = RangeDecoder(data)
        if before is not None:
            self.mixer, self.calm, self.escape = before.mixer, before.calm, before.escape
            return
        self.mixer = Mixer([NODES * contexts for contexts in TABLE_CONTEXTS], NODES, 40, ShortBit)
        self.calm = adaptive_bits(4)
        self.escape = [adaptive_bits(55) for _ in range(8)]

    def decode(self, surroundings):
        b = 0
        calm_class = surroundings.calm_class()
        if calm_class is not None:
            if not self.calm[calm_class].decode(self.decoder):
                return 0
            b = 1
        contexts = Contexts(surroundings)
        if contexts.unsure:
            b = self.decode_unsure(contexts)
        else:
            while b < BINS and self.decode_node(contexts, b):
                b += 1
        if b == 0:
            return 0
        extra = 0 if b < 8 else (b - 8) // 4 + 1
        begin = b if b < 8 else (4 + (b - 8) % 4) << extra
        if b < BINS:
            size = begin + self.decoder.decode_bits(extra)
        else:
            size = begin + self.decode_escape(contexts.escape_class)
        return -size if self.decoder.decode(EVEN) else size

    def decode_node(self, contexts, node):
        return self.mixer.decode(self.decoder, [context * NODES + node for context in contexts.tables], node)

    def decode_unsure(self, contexts):
        b = 0
        while b < BINS and self.decode_node(contexts, BINS + b):
            b += 4
        if b == BINS:
            return b
        upper = self.decode_node(contexts, BINS + b + 1)
        return b + 2 * upper + self.decode_node(contexts, BINS + b + 2 + upper)

    def decode_escape(self, c):
        length = 0
        while length < 55 and self.escape[c][length].decode(self.decoder, 30):
            length += 1
        sent = min(length, 24)
        return (1 << length) + (self.decoder.decode_bits(sent) << (length - sent)) - 1


class Field:
    def __init__(self, data, rows, options, positions=None, before=None):
        """positions: grid position of every row, where weights learn from the reference. before: the field of the group
        that this one continues."""
        self.rows = rows
        self.options = options
        self.residuals = ResidualDecoder(data, before and before.residuals)
        self.magnitude = [0] * len(rows)
        self.last = [0] * len(rows)
        self.history = [0] * len(rows)
        self.recent = 0
        self.planes = []
        self.weights = []
        if before is not None and options.adapt and positions is not None:
            self.weights = before.weights
            for weights in self.weights:
                weights.fade()
                weights.solve()
        elif options.predict:
            self.weights = [RowWeights(rows, r, options.weights) for r in range(len(rows))]
            for weights in self.weights:
                if positions is not None:
                    weights.observe_reference(positions)
                weights.solve()

    def decode_component(self, k):
        """Section 1."""
        count = len(self.rows)
        plane = [0.0] * count
        energy = 0.0
        for r, row in enumerate(self.rows):
            step = STEPS[row.step_index] if self.options.predict else 65536
            n = self.residuals.decode(self.surroundings(r, step))
            correction = product32(f32(n), f32(step / 65536))
            plane[r] = sum32(self.prediction(r, plane), correction)
            require(math.isfinite(plane[r]), "a value is beyond binary32")
            if r >= count // 4:
                energy = energy + correction * correction
            self.note(r, n, step)
        self.residuals.decoder.check()
        self.planes.append(plane)
        self.finish(k, energy)

    def prediction(self, r, plane):
        """Section 2."""
        if not self.options.predict:
            return 0.0
        s = [0.0] * 4
        w = self.weights[r].w
        for i, n in enumerate(self.rows[r].neighbours):
            s[i % 4] = sum32(s[i % 4], product32(w[i], plane[n]))
        return sum32(sum32(s[0], s[1]), sum32(s[2], s[3]))

    def surroundings(self, r, step):
        """Section 3, first half."""
        row = self.rows[r]
        ring = [self.magnitude[n] for n in row.neighbours[:row.ring]]
        others = [self.magnitude[n] for n in row.neighbours[row.ring:]]

        def mean(values):
            return sum(values) * (65536 // len(values)) >> 16

        ring_mean = mean(ring) if ring else 0
        return Surroundings(
            ring_mean=ring_mean,
            extra_mean=mean(others) if others else ring_mean,
            recent=self.recent // 4,
            history=self.history[r],
            last=self.last[r],
            step=step)

    def note(self, r, n, step):
        """Section 5."""
        magnitude = min((abs(n) * step) >> 8, (1 << 24) - 1)
        self.magnitude[r] = magnitude
        self.recent += magnitude
        self.recent -= self.recent // 4

    def finish(self, k, energy):
        """Section 5."""
        rows = self.rows
        self.history = [(h * 154 + m * 102) >> 8 for h, m in zip(self.history, self.magnitude)]
        self.last = self.magnitude
        self.magnitude = [0] * len(rows)
        self.recent = 0
        if not self.options.adapt:
            return
        noise = self.options.noise_share * (energy / (len(rows) - len(rows) // 4)) + self.options.noise_floor
        for weights, magnitude in zip(self.weights, self.last):
            weights.note(self.planes[-1], noise, magnitude != 0)
            if weights.misses >= misses_to_solve(k):
                weights.solve()
            if k % 16 == 15:
                weights.end_list()


def decode_field(data, rows, components, options, positions=None, before=None):
    """A section; the result's `planes` are its values."""
    field = Field(data, rows, options, positions if options.predict else None, before)
    for k in range(components):
        field.decode_component(k)
    return field
