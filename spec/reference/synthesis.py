"""synthesis.md: from planes to positions."""
import math

from .arithmetic import f32, product32, sum32
from .errors import require


class Synthesis:
    """Main and fast profile, section 1."""

    def __init__(self, vertex_count, planes, basis_planes, time_order, step, origin, corrections):
        self.planes = planes
        self.corrections = corrections
        mean_scale = step / math.sqrt(vertex_count)
        self.mean = [0.0] * len(time_order)
        for r, c in enumerate(time_order):
            self.mean[c] = origin[c % 3] + basis_planes[0][r] * mean_scale
        basis = [self.basis_vector(plane, basis_planes[k + 1], time_order) for k, plane in enumerate(planes)]
        self.choose_narrow(basis)
        self.unit = f32(step / 2097152)
        self.basis_wide = [[f32(x * step) for x in vector] for vector in basis[:self.wide]]
        values = self.mean + [x for vector in self.basis_wide for x in vector] + [self.unit]
        require(all(math.isfinite(x) for x in values), "the basis is out of range")

    def basis_vector(self, plane, coded, time_order):
        norm = 0.0
        for x in plane:
            norm = norm + x * x
        norm = math.sqrt(norm)
        scale = 1 / norm if norm > 0 else 0.0
        vector = [0.0] * len(time_order)
        for r, c in enumerate(time_order):
            vector[c] = coded[r] * scale
        return vector

    def choose_narrow(self, basis):
        """The components from self.wide on, the last one first."""
        self.narrow = []  # (plane_integer, basis_integer)
        self.wide = len(self.planes)
        room = 2**31 - 1
        while self.wide > 0:
            scaled = [64 * x for x in self.planes[self.wide - 1]], [32768 * x for x in basis[self.wide - 1]]
            if not all(abs(x) < 32768 for values in scaled for x in values):
                break
            p, b = ([round(x) for x in values] for values in scaled)  # ties to even
            P, B = (max(abs(x) for x in values) for values in (p, b))
            if P > 32767 or B > 32767 or P * B > room:
                break
            room -= P * B
            self.wide -= 1
            self.narrow.append((p, b))

    def position(self, row, t):
        position = []
        for axis in range(3):
            c = 3 * t + axis
            total = 0.0
            for vector, plane in zip(self.basis_wide, self.planes):
                total = sum32(total, product32(vector[c], plane[row]))
            n = sum(b[c] * p[row] for p, b in self.narrow)
            total = sum32(total, product32(self.unit, f32(n)))
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
