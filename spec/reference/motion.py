"""motion.md: regions and their transforms."""
from .arithmetic import divide, f32, product32, sum32
from .entropy import AdaptiveBit, ExpGolomb, RangeDecoder, SignedInteger, adaptive_bits
from .errors import require


class RegionModel:
    def __init__(self):
        self.hit = [adaptive_bits(3) for _ in range(4)]
        self.outright = ExpGolomb()

    def decode(self, decoder, suggested):
        k = min(len(suggested), 3)
        for i in range(k):
            if self.hit[k][i].decode(decoder):
                return suggested[i]
        return self.outright.decode(decoder)


class Motion:
    """positions: grid position of every row."""

    def __init__(self, data, rows, region_count, component_count, thesis, positions):
        self.rows = rows
        self.regions = region_count
        self.positions = positions
        self.primary = [0] * len(rows)
        self.secondary = [0] * len(rows)
        self.weight = [0] * len(rows)
        self.decoder = RangeDecoder(data)
        self.decode_bindings()
        self.decode_transforms(component_count, thesis)
        self.decoder.check()
        self.locate()

    def decode_bindings(self):
        """Section 1."""
        first, second = RegionModel(), RegionModel()
        blended, tree = adaptive_bits(8), adaptive_bits(8)
        for r, row in enumerate(self.rows):
            near = self.suggestions(r, None)
            self.primary[r] = first.decode(self.decoder, near)
            ring = row.neighbours[:row.ring]
            beside = 1 if any(self.weight[n] > 0 for n in ring) else 0
            if blended[2 * min(len(near), 3) + beside].decode(self.decoder):
                self.secondary[r] = second.decode(self.decoder, self.suggestions(r, self.primary[r]))
                node = 1
                for _ in range(3):
                    node = 2 * node + tree[node].decode(self.decoder)
                self.weight[r] = node - 7
            require(max(self.primary[r], self.secondary[r]) < self.regions, "a region is out of range")
            self.decoder.check()

    def suggestions(self, r, besides):
        row = self.rows[r]
        found = []
        count = {}
        for n in row.neighbours[:row.ring]:
            g = self.primary[n]
            if g == besides:
                continue
            if g not in count:
                found.append(g)
                count[g] = 1
                continue
            count[g] += 1
            i = found.index(g)
            while i > 0 and count[found[i - 1]] < count[g]:
                found[i - 1], found[i] = found[i], found[i - 1]
                i -= 1
        return found

    def decode_transforms(self, components, thesis):
        """Section 2."""
        used = AdaptiveBit()
        entry = [[SignedInteger() for _ in range(16)] for _ in range(2)]
        self.transform = []
        for k in range(components):
            z = [[0] * 4 for _ in range(self.regions)]
            if used.decode(self.decoder, 30):
                scale = 0
                for b in range(self.regions):
                    for i in range(4):
                        d = entry[1 if i == 3 else 0][min(scale, 15)].decode(self.decoder)
                        scale = (scale + abs(d).bit_length() + 1) // 2
                        z[b][i] = d
            if thesis and k >= 3:
                for b in range(self.regions):
                    for i in range(4):
                        z[b][i] = wrap(z[b][i] + self.transform[k - 3][b][i])
            self.decoder.check()
            self.transform.append(z)

    def locate(self):
        """Section 3."""
        self.centre = []
        self.extent = []
        for b in range(self.regions):
            members = [p for p, region in zip(self.positions, self.primary) if region == b]
            centre = [divide(sum(p[a] for p in members), max(1, len(members))) for a in range(3)]
            self.centre.append(centre)
            self.extent.append(max([1] + [abs(p[a] - centre[a]) for p in members for a in range(3)]))

    def moved(self, r, b, k):
        """Section 4."""
        total = 0.0
        for i in range(4):
            u = 1.0
            if i < 3:
                u = f32(f32(self.positions[r][i] - self.centre[b][i]) / f32(self.extent[b]))
            total = sum32(total, product32(product32(f32(self.transform[k][b][i]), 0.5), u))
        return total

    def motion(self, r, k):
        m = self.moved(r, self.primary[r], k)
        if self.weight[r] > 0:
            m = sum32(m, product32(self.weight[r] / 16, f32(self.moved(r, self.secondary[r], k) - m)))
        return m


def wrap(x):
    """Modulo 2^32, with sign."""
    return (x + (1 << 31)) % (1 << 32) - (1 << 31)
