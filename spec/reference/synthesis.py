"""synthesis.md: from planes to positions."""
import math

from .arithmetic import f32, product32, sum32
from .errors import require


class Synthesis:
    """Main and fast profile, section 1."""

    def __init__(self, vertex_count, planes, basis_planes, time_order, step, origin, corrections):
        self.planes = planes
        self.corrections = corrections
        self.mean = [0.0] * len(time_order)
        self.basis = [[0.0] * len(planes) for _ in time_order]
        mean_scale = step / math.sqrt(vertex_count)
        for r, c in enumerate(time_order):
            self.mean[c] = origin[c % 3] + basis_planes[0][r] * mean_scale
        for k, plane in enumerate(planes):
            norm = 0.0
            for x in plane:
                norm = norm + x * x
            norm = math.sqrt(norm)
            scale = step / norm if norm > 0 else 0.0
            for r, c in enumerate(time_order):
                self.basis[c][k] = f32(basis_planes[k + 1][r] * scale)
        values = self.mean + [x for row in self.basis for x in row]
        require(all(math.isfinite(x) for x in values), "the basis is out of range")

    def position(self, row, t):
        position = []
        for axis in range(3):
            c = 3 * t + axis
            total = 0.0
            for k, plane in enumerate(self.planes):
                total = sum32(total, product32(self.basis[c][k], plane[row]))
            position.append(f32(self.mean[c] + total))
        return self.corrections.apply(position, row, t)


class ThesisSynthesis:
    """Section 2."""

    def __init__(self, planes, axis_step, origin, corrections):
        self.planes, self.axis_step, self.origin = planes, axis_step, origin
        self.corrections = corrections

    def position(self, row, t):
        planes = self.planes[3 * t:3 * t + 3]
        position = [f32(self.origin[a] + product32(self.axis_step[a], planes[a][row])) for a in range(3)]
        return self.corrections.apply(position, row, t)
