"""attributes.md sections 6 to 11: values of attributes. Reals are binary64."""
import math
import struct
from dataclasses import dataclass

from .arithmetic import clamp, f32
from .attribute_chunks import BINARY32, FACE, FORMATS, RANGES, TEXTURE_COORDINATE, read_body
from .bytes import LARGEST_F32
from .entropy import EVEN, AdaptiveBit, ExpGolomb, IntervalDecoder, SignedInteger
from .errors import require
from .fast import Walk
from .guesses import Guess, GuessMixture
from .half_edges import NONE
from .mirror import MirrorGuess, decode_plane
from .points import FeatureWeights
from .sites import Corners, Sites, decode_sites

MOST_MIXED = (1 << 20) - 1
STEPS = 17


class Differences:
    """Section 7."""

    def __init__(self):
        self.lengths = [[AdaptiveBit() for _ in range(STEPS)] for _ in range(34)]
        self.top = [[AdaptiveBit() for _ in range(4)] for _ in range(34)]
        self.sign = AdaptiveBit()

    def decode(self, decoder, expected):
        models = self.lengths[min(expected.bit_length(), 33)]
        length = max(min(expected.bit_length(), 33), 1)

        def reaches(least, step):
            return least < 34 and models[step].decode(decoder)

        step = 8
        if reaches(length, step):
            while True:
                step = min(step + 1, STEPS - 1)
                if not reaches(length + 1, step):
                    break
                length += 1
        else:
            length -= 1
            while length > 0:
                step = max(step, 1) - 1
                if reaches(length, step):
                    break
                length -= 1
        if length == 0:
            return 0
        negative = self.sign.decode(decoder)
        value = 1
        for _ in range(length - 1):
            bit = self.top[length][value].decode(decoder) if value < 4 else decoder.decode(EVEN)
            value = 2 * value + bit
        return -value if negative else value


FITTED, BY_SPREAD, SHIFTED, BASE, CONFORMAL, AFFINE, TIP, SAME, SIBLING, MIDDLE, MIRRORED, MIRROR_SAME = range(12)


def guess_at(kind, place, scale):
    return Guess(kind, math.floor(place * 256 + 0.5) + 128, int(clamp(scale * 256, 64.0, 16777216.0)))


@dataclass
class Unfolded:
    """Section 6: a known triangle."""
    a: int
    b: int
    c: int
    flat: bool
    along: float = 0.0
    beside: float = 0.0
    c_along: float = 0.0
    c_beside: float = 0.0


class Predictor:
    """Section 6."""

    def __init__(self, sites, walk, tops, texture, plane):
        self.sites, self.walk, self.tops = sites, walk, tops
        self.texture = texture and len(tops) >= 2
        self.mirror = MirrorGuess(sites, walk, len(tops), self.texture, plane)
        self.weights = [FeatureWeights() for _ in range(4)]
        self.error = [0.0] * len(sites.grid)
        self.sibling = {}
        self.turning = 0
        self.last = NONE
        self.values = [None] * len(sites.grid)

    def unfold(self, site, a, b, c):
        grid = self.sites.grid
        edge = [float(grid[b][i]) - float(grid[a][i]) for i in range(3)]
        edge2 = 0.0
        for d in edge:
            edge2 = edge2 + d * d
        if edge2 == 0:
            return Unfolded(a, b, c, True)

        def place(s):
            dot, length2 = 0.0, 0.0
            for i in range(3):
                d = float(grid[s][i]) - float(grid[a][i])
                dot = dot + d * edge[i]
                length2 = length2 + d * d
            along = dot / edge2
            return along, math.sqrt(max(length2 / edge2 - along * along, 0.0))

        out = Unfolded(a, b, c, False, *place(site))
        if c != NONE:
            out.c_along, out.c_beside = place(c)
        return out

    def side(self, t):
        """1 left, -1 right."""
        if t.c != NONE:
            a, b, c = (self.values[s] for s in (t.a, t.b, t.c))
            area = float(b[0] - a[0]) * float(c[1] - a[1]) - float(b[1] - a[1]) * float(c[0] - a[0])
            if area != 0:
                return -1.0 if area > 0 else 1.0
        return 1.0 if self.turning >= 0 else -1.0

    def start(self, turn):
        self.site = site = self.walk.order[turn]
        count = len(self.tops)
        self.triangles = [self.unfold(site, *known) for known in self.walk.known[turn]]
        mean, affine, conformal = [0.0] * count, [0.0] * count, [0.0] * count
        tips, squares = [0.0] * count, [0.0] * count
        self.tips = sum(1 for t in self.triangles if t.c != NONE)
        near = 0.0
        for t in self.triangles:
            unfolds = t.c != NONE and not t.flat and t.c_beside > 0
            ratio = min(t.beside / t.c_beside, 8.0) if unfolds else 0.0
            for k in range(count):
                a, b = float(self.values[t.a][k]), float(self.values[t.b][k])
                mean[k] = mean[k] + (a + b) / 2
                foot = a + t.along * (b - a)
                if t.c == NONE:
                    affine[k] = affine[k] + ((a + b) / 2 if t.flat else foot)
                    continue
                x = float(self.values[t.c][k])
                tip = a + b - x
                tips[k] = tips[k] + tip
                squares[k] = squares[k] + tip * tip
                affine[k] = affine[k] + (foot - ratio * (x - a - t.c_along * (b - a)) if unfolds else tip)
            if self.texture:
                side = self.side(t) * t.beside
                u, v = (float(x) for x in self.values[t.a][:2])
                du, dv = float(self.values[t.b][0]) - u, float(self.values[t.b][1]) - v
                conformal[0] = conformal[0] + (u + t.along * du - side * dv)
                conformal[1] = conformal[1] + (v + t.along * dv + side * du)
            near = near + (self.error[t.a] + self.error[t.b])
        self.near = near / (2 * float(len(self.triangles))) if self.triangles else 0.0
        self.find_candidates()
        self.mirror.start(site, self.walk.known[turn], self.values)
        w = self.weights[min(self.tips, 3)].solve()
        self.base, self.fitted, self.features, self.spread = [], [], [], []
        self.affine, self.conformal = affine, conformal
        for k in range(count):
            if not self.triangles:
                near_value = self.candidates[0][0][k] if self.candidates else self.tops[k] / 2
                base, features, spread = float(near_value), [0.0] * 3, 0.3
            else:
                n = float(len(self.triangles))
                mean[k], affine[k], conformal[k] = mean[k] / n, affine[k] / n, conformal[k] / n
                base = tips[k] / self.tips if self.tips else mean[k]
                planar = self.texture and k < 2
                features = [mean[k] - base, conformal[k] - base if planar else 0.0, affine[k] - base]
                square = squares[k] / self.tips - base * base if self.tips else 0.0
                spread = 0.3 + 0.7 * math.sqrt(max(square, 0.0))
            fitted = base
            for i in range(3):
                fitted = fitted + w[i] * features[i]
            self.base.append(base)
            self.features.append(features)
            self.spread.append(spread)
            self.fitted.append(clamp(fitted, 0.0, float(self.tops[k])))
        self.coded = []
        self.error_sum = self.shift = 0.0

    def find_candidates(self):
        """[values, whether a sibling's, whether a channel so far is another]."""
        sites = []
        if self.sites.vertex is not None and self.sites.vertex[self.site] in self.sibling:
            sites.append((self.sibling[self.sites.vertex[self.site]], True))
        for t in self.triangles[:2]:
            sites += [(t.a, False), (t.b, False)]
        if not self.triangles and self.last != NONE:
            sites.append((self.last, False))
        self.candidates = []
        for site, sibling in sites:
            if all(self.values[site] != known[0] for known in self.candidates):
                self.candidates.append([self.values[site], sibling, False])

    def scale(self, k):
        of_neighbours = self.near + 0.3
        if k == 0:
            return of_neighbours
        return max((2 * of_neighbours + self.error_sum / float(k)) / 3, 0.3)

    def guesses(self, k):
        top = float(self.tops[k])
        situation = 1 + min(self.tips, 3) if self.tips else (1 if self.triangles else 0)
        scale = self.scale(k)
        out = []

        def add(kind, place, s):
            out.append(guess_at(5 * kind + situation, place, s))

        def cut(x):
            return clamp(x, 0.0, top)

        for values, sibling, missed in self.candidates:
            kind = 5 * (SIBLING if sibling else SAME) + (0 if k == 0 else 2 if missed else 1)
            out.append(guess_at(kind, float(values[k]), 0.3))
        mirror = self.mirror
        if mirror.same != NONE:
            kind = 5 * MIRROR_SAME + (0 if k == 0 else 2 if mirror.missed else 1)
            out.append(guess_at(kind, float(self.values[mirror.same][k]), 0.3))
        if mirror.targets is not None:
            add(MIRRORED, cut(mirror.targets[k]), mirror.scale(k))
        if not self.triangles:
            add(BASE, self.base[k], scale)
            add(MIDDLE, top / 2, top / 4 + 0.3)
            return out
        add(FITTED, self.fitted[k], scale)
        if k > 0:
            add(SHIFTED, cut(self.fitted[k] + self.shift), scale)
        if self.tips < 2:
            add(BASE, cut(self.base[k]), scale)
        if self.tips > 0:
            add(AFFINE, cut(self.affine[k]), scale)
        if self.texture and k < 2:
            add(CONFORMAL, cut(self.conformal[k]), scale)
        if self.tips < 2:
            return out
        add(BY_SPREAD, self.fitted[k], self.spread[k])
        for t in [t for t in self.triangles if t.c != NONE][:2]:
            a, b, c = (float(self.values[s][k]) for s in (t.a, t.b, t.c))
            add(TIP, cut(a + b - c), scale)
        return out

    def learn(self, k, value):
        self.coded.append(value)
        self.shift = float(value) - self.fitted[k]
        self.error_sum = self.error_sum + abs(self.shift)
        if self.triangles:
            self.weights[min(self.tips, 3)].observe(self.features[k], self.near, self.shift, value - self.base[k])
        for candidate in self.candidates:
            candidate[2] = candidate[2] or candidate[0][k] != value
        self.mirror.learn(k, value)
        if k + 1 == len(self.tops):
            self.finish()

    def finish(self):
        site = self.site
        self.mirror.finish(self.coded)
        self.values[site] = self.coded
        self.error[site] = f32(self.error_sum / float(len(self.tops)))
        self.last = site
        if self.sites.vertex is not None:
            self.sibling[self.sites.vertex[site]] = site
        if not self.texture or not self.triangles:
            return
        t = self.triangles[0]
        a, b, x = self.values[t.a], self.values[t.b], self.coded
        area = float(b[0] - a[0]) * float(x[1] - a[1]) - float(b[1] - a[1]) * float(x[0] - a[0])
        if area != 0:
            self.turning = clamp(self.turning + (1 if area > 0 else -1), -8, 8)


def decode_values(decoder, sites, tops, texture):
    """Sections 6 and 7: the integers of every site."""
    plane = decode_plane(decoder)
    walk = Walk(len(sites.grid), sites.triangles)
    predictor = Predictor(sites, walk, tops, texture, plane)
    mixture = GuessMixture(60, 256)
    differences = [Differences() for _ in tops]
    for turn in range(len(walk.order)):
        predictor.start(turn)
        for k, top in enumerate(tops):
            if top <= MOST_MIXED:
                value = mixture.decode(decoder, predictor.guesses(k), top + 1)
            else:
                value = math.floor(predictor.fitted[k] + 0.5)
                value += differences[k].decode(decoder, int(predictor.scale(k)))
                require(0 <= value <= top, "an attribute's value is out of range")
            predictor.learn(k, value)
        decoder.check()
    return predictor.values


def elements_near(domain, faces):
    """Section 8: of every face, or corner, those that it may be like."""
    corners = Corners(faces)
    if domain == FACE:
        across = [[] for _ in faces]
        for c, t in enumerate(corners.twin):
            if t != NONE:
                across[corners.face[c]].append(corners.face[t])
        return across
    near = []
    for c, t in enumerate(corners.twin):
        into = corners.twin[corners.preceding[c]]
        near.append(([corners.following[t]] if t != NONE else []) + ([into] if into != NONE else []))
    return near


def decode_categories(decoder, domain, faces, top):
    """Section 8."""
    across = elements_near(domain, faces)
    same, beside = {}, [AdaptiveBit() for _ in range(3)]
    rank_model, new_model = ExpGolomb(), SignedInteger()
    values, recent = [], []
    newest, differs = -1, 0

    def decode_new():
        nonlocal newest
        value = clamp(newest + new_model.decode(decoder), 0, top + 1)
        newest = value if domain == FACE else max(newest, value)
        return value

    for f in range(len(across)):
        if f == 0:
            value = decode_new()
        else:
            before = values[-1]
            near = [values[g] for g in across[f] if g < f]
            others = [x for x in near if x != before]
            context = (min(len(near) - len(others), 2), min(len(others), 2), differs)
            differs = 1 - same.setdefault(context, AdaptiveBit()).decode(decoder)
            if not differs:
                value = before
            elif others and beside[context[0]].decode(decoder):
                value = others[0]
            elif domain != FACE:
                value = decode_new()
            else:
                rank = rank_model.decode(decoder)
                value = recent[rank] if rank < len(recent) else decode_new()
        decoder.check()
        require(value <= top, "an attribute's value is out of range")
        if value in recent:
            recent.remove(value)
        recent = [value] + recent[:255]
        values.append(value)
    return [[x] for x in values]


def decode_exceptions(decoder, count):
    """Section 9: bits by number of the integer."""
    number_model, gap_model = ExpGolomb(), ExpGolomb()
    number = number_model.decode(decoder)
    require(number <= count, "more exceptions than values")
    exceptions, at = {}, 0
    for _ in range(number):
        at += gap_model.decode(decoder)
        bits = 0
        for _ in range(32):
            bits = 2 * bits + decoder.decode(EVEN)
        require(at < count, "an exception beyond the values")
        decoder.check()
        exceptions[at] = bits
        at += 1
    return exceptions


def animated_sites(attribute, grid, faces):
    section = read_body(attribute)
    decoder = IntervalDecoder(section)
    sites = decode_sites(decoder, attribute.domain, grid, faces)
    corrections = None
    if attribute.channels:
        rows = decode_values(decoder, sites, [c.top for c in attribute.channels], False)
        corrections = [[c.number(BINARY32, n) for c, n in zip(attribute.channels, row)] for row in rows]
    decoder.check()
    return sites, corrections


def number_of(kind, scale, coordinate):
    """Section 10: bits of a binary32, or an integer."""
    number = scale * coordinate
    if kind == BINARY32:
        return struct.unpack("<I", struct.pack("<f", f32(clamp(number, -LARGEST_F32, LARGEST_F32))))[0]
    low, high = RANGES[kind]
    return int(clamp(math.floor(number + 0.5), low, high))


def site_numbers(attribute, scales, coordinates):
    """`coordinates`: of each site, all channels."""
    return [[number_of(attribute.kind, s, x) for s, x in zip(scales, row)] for row in coordinates]


def pack_frame(attribute, sites, numbers):
    form = FORMATS[attribute.kind]
    packed = [b"".join(struct.pack(form, x) for x in row) for row in numbers]
    return b"".join(packed[site] for site in sites.of_element)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def normalised(a):
    """None where it has no direction."""
    length = math.sqrt(dot(a, a))
    if not 0 < length < math.inf:
        return None
    scale = 1 / length
    return [x * scale for x in a]


def turned(total, edge, u, v):
    """Section 11."""
    normal = normalised(total)
    if u == 0 and v == 0:
        return normal or [0.0, 0.0, 0.0]
    along = None
    if normal is None:
        normal = [0.0, 0.0, 1.0]
    else:
        factor = -dot(edge, normal)
        along = normalised([e + factor * n for e, n in zip(edge, normal)])
    if along is None:
        least = min(range(3), key=lambda k: abs(normal[k]))
        along = normalised([(1.0 if k == least else 0.0) + -normal[least] * normal[k] for k in range(3)])
    across = [normal[1] * along[2] - normal[2] * along[1], normal[2] * along[0] - normal[0] * along[2],
              normal[0] * along[1] - normal[1] * along[0]]
    x, y, z = u, v, 1 - abs(u) - abs(v)
    if z < 0:
        x = (1 - abs(v)) * (-1.0 if u < 0 else 1.0)
        y = (1 - abs(u)) * (-1.0 if v < 0 else 1.0)
    out = [x * a + y * b + z * n for a, b, n in zip(along, across, normal)]
    return normalised(out) or out


def pack_normals(sites, positions, corrections):
    """Section 11: normals computed from the positions of a frame; `corrections`: bits of u and v of each site."""
    places = positions if sites.vertex is None else [positions[v] for v in sites.vertex]
    sums = [[0.0] * 3 for _ in places]
    edges = [None] * len(places)
    for i in range(0, len(sites.triangles), 3):
        corners = sites.triangles[i:i + 3]
        for k, c in enumerate(corners):
            if edges[c] is None:
                edges[c] = [places[corners[(k + 1) % 3]][a] - places[c][a] for a in range(3)]
        p, q, r = (places[c] for c in corners)
        u = [q[k] - p[k] for k in range(3)]
        v = [r[k] - p[k] for k in range(3)]
        area = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        for c in corners:
            sums[c] = [s + a for s, a in zip(sums[c], area)]
    packed = []
    for site, total in enumerate(sums):
        bits = corrections[site] if corrections is not None else (0, 0)
        u, v = (struct.unpack("<f", struct.pack("<I", b))[0] for b in bits)
        packed.append(struct.pack("<3f", *(f32(x) for x in turned(total, edges[site] or [0.0] * 3, u, v))))
    return b"".join(packed[site] for site in sites.of_element)


def decode_static(attribute, grid, faces):
    """The bytes of all values, element after element."""
    section = read_body(attribute)
    decoder = IntervalDecoder(section)
    if attribute.categorical():
        integers = decode_categories(decoder, attribute.domain, faces, attribute.channels[0].top)
        sites = Sites(None, None, list(range(len(integers))))
    else:
        sites = decode_sites(decoder, attribute.domain, grid, faces)
        tops = [channel.top for channel in attribute.channels]
        integers = decode_values(decoder, sites, tops, attribute.semantic == TEXTURE_COORDINATE)
    exceptions = {}
    if attribute.kind == BINARY32:
        exceptions = decode_exceptions(decoder, len(integers) * attribute.channel_count)
    decoder.check()
    numbers = [[c.number(attribute.kind, n) for c, n in zip(attribute.channels, row)] for row in integers]
    for at, bits in exceptions.items():
        numbers[at // attribute.channel_count][at % attribute.channel_count] = bits
    packed = [b"".join(struct.pack(FORMATS[attribute.kind], x) for x in row) for row in numbers]
    return b"".join(packed[site] for site in sites.of_element)
