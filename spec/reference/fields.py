"""fields.md: the coefficients and the basis of a group."""
import math
from dataclasses import dataclass

from .arithmetic import f32, floor_log2, log2_5, product32, sum32
from .container import MAIN, THESIS
from .entropy import EVEN, Mixer, RangeDecoder, adaptive_bits
from .errors import require
from .surface import STEPS
from .weights import BASIS_WEIGHTS, COEFFICIENT_WEIGHTS, RowWeights, WeightOptions, due


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
BASIS = FieldOptions(BASIS_WEIGHTS, True, True, 0.5, 0.05)

TABLE_CONTEXTS = (256, 32, 192, 96, 192, 320, 256, 256)
BINS = 24


def classify(x, c, s):
    """class(x, c, s) of section 3."""
    return min(c - 1, (log2_5(256 + 4 * x) - 256) * s // 128)


@dataclass
class Surroundings:
    """Section 3."""
    ring_mean: int
    ring_max: int
    extra_mean: int
    history: int
    ring_history: int
    last: int
    running: int
    recent: int
    level: int
    component: int


class Contexts:
    """Section 3, second half."""

    def __init__(self, s):
        near = (2 * s.ring_mean + s.history + s.recent) // 4
        everything = (3 * s.ring_mean + 2 * s.extra_mean + 4 * s.recent + s.running + 5 * s.history +
                      3 * s.ring_history) // 18
        self.tables = (
            classify(s.ring_mean, 16, 8) * 16 + classify(s.history, 16, 8),
            classify(near, 32, 12),
            classify(s.ring_history, 16, 8) * 12 + classify(s.running, 12, 6),
            classify(s.ring_max, 12, 6) * 8 + s.level,
            classify(everything, 24, 10) * 8 + s.level,
            min(31, s.component) * 10 + classify(everything, 10, 5),
            classify(s.recent, 16, 8) * 16 + classify(s.last, 16, 8),
            classify(s.extra_mean, 16, 8) * 16 + classify((s.ring_mean + s.recent) // 2, 16, 8),
        )
        self.weight_class = classify(everything, 6, 5)
        self.escape_class = classify(near, 8, 3)


class ResidualDecoder:
    """Section 4. before: that of the group that this one continues, section 6."""

    def __init__(self, data, before=None):
        self.decoder = RangeDecoder(data)
        if before is not None:
            self.mixer, self.escape = before.mixer, before.escape
            return
        self.mixer = Mixer([BINS * contexts for contexts in TABLE_CONTEXTS], BINS * 6, 100)
        self.escape = [adaptive_bits(55) for _ in range(8)]

    def decode(self, contexts):
        b = 0
        while b < BINS and self.mixer.decode(self.decoder, [context * BINS + b for context in contexts.tables],
                                             b * 6 + contexts.weight_class):
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
        self.ring_history = [0] * len(rows)
        self.running = 0
        self.recent = 0
        self.planes = []
        self.weights = []
        if before is not None and options.adapt and positions is not None:
            self.weights = before.weights
            for weights in self.weights:
                weights.forget()
                weights.solve()
        elif options.predict:
            self.weights = [RowWeights(rows, r, options.weights) for r in range(len(rows))]
            for weights in self.weights:
                weights.solve()
                if positions is not None:
                    weights.observe_reference(positions)
                    weights.solve()

    def decode_component(self, k):
        """Section 1."""
        count = len(self.rows)
        plane = [0.0] * count
        energy = 0.0
        for r, row in enumerate(self.rows):
            step = STEPS[row.step_level] if self.options.predict else 65536
            n = self.residuals.decode(Contexts(self.surroundings(r, step, k)))
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

    def surroundings(self, r, step, k):
        """Section 3, first half."""
        row = self.rows[r]
        ring = [self.magnitude[n] for n in row.neighbours[:row.ring]]
        others = [self.magnitude[n] for n in row.neighbours[row.ring:]]

        def relative(x):
            return min((x << 16) // step, 1 << 24)

        ring_mean = relative(sum(ring) // len(ring)) if ring else 0
        return Surroundings(
            ring_mean=ring_mean,
            ring_max=relative(max(ring)) if ring else 0,
            extra_mean=relative(sum(others) // len(others)) if others else ring_mean,
            history=relative(self.history[r]),
            ring_history=relative(self.ring_history[r]),
            last=relative(self.last[r]),
            running=relative(self.running // 32),
            recent=relative(self.recent // 4),
            level=min(7, floor_log2(max(1, len(self.rows) // (r + 1)))),
            component=k)

    def note(self, r, n, step):
        """Section 5."""
        magnitude = min((min(abs(n), 1 << 32) * step) >> 8, 1 << 24)
        self.magnitude[r] = magnitude
        self.running += magnitude
        self.running -= self.running // 32
        self.recent += magnitude
        self.recent -= self.recent // 4

    def finish(self, k, energy):
        """Section 5."""
        rows = self.rows
        self.history = [(h * 154 + m * 102) >> 8 for h, m in zip(self.history, self.magnitude)]
        self.ring_history = [sum(self.history[n] for n in row.links) // len(row.links) if row.links else 0
                             for row in rows]
        self.last = self.magnitude
        self.magnitude = [0] * len(rows)
        self.running = self.recent = 0
        if not self.options.adapt:
            return
        noise = self.options.noise_share * (energy / (len(rows) - len(rows) // 4)) + self.options.noise_floor
        for weights in self.weights:
            weights.observe(self.planes[-1], noise)
            if due(k):
                weights.solve()


def decode_field(data, rows, components, options, positions=None, before=None):
    """A section; the result's `planes` are its values."""
    field = Field(data, rows, options, positions if options.predict else None, before)
    for k in range(components):
        field.decode_component(k)
    return field
