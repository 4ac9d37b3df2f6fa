"""container.md section 1: descriptors."""
import struct

from .errors import Corrupt, Truncated, require


class Reader:
    """Reads fields from bytes[position:]. A field that the bytes do not hold raises Truncated."""

    def __init__(self, data, position=0):
        self.data = data
        self.position = position

    def remaining(self):
        return len(self.data) - self.position

    def take(self, count):
        if count > self.remaining():
            raise Truncated("the bytes end inside a field")
        self.position += count
        return self.data[self.position - count:self.position]

    def u8(self, name, low, high):
        return in_range(self.take(1)[0], name, low, high)

    def u32(self):
        return struct.unpack("<I", self.take(4))[0]

    def uv(self, name="number", low=0, high=(1 << 64) - 1):
        value = 0
        for i in range(10):
            byte = self.take(1)[0]
            value += (byte & 127) << (7 * i)
            if byte < 128:
                require(byte != 0 or i == 0, name + " is padded")
                require(value < 1 << 64, name + " is too large")
                return in_range(value, name, low, high)
        require(False, name + " has more than ten bytes")

    def flags(self, name, allowed):
        """A byte of flags, of which only the bits of `allowed` may be set."""
        value = self.take(1)[0]
        require(value & ~allowed == 0, name + " has a reserved bit set")
        return value

    def f32(self, name, low, high):
        return in_range(struct.unpack("<f", self.take(4))[0], name, low, high)

    def f64(self, name, low, high):
        count = self.u8(name, 0, 8)
        front = self.take(count)
        require(count == 0 or front[-1] != 0, name + " is padded")
        return in_range(struct.unpack(">d", front + bytes(8 - count))[0], name, low, high)

    def text(self, name):
        encoded = self.take(self.uv(name))
        try:
            return encoded.decode("utf-8")
        except UnicodeDecodeError:
            raise Corrupt(name + " is not UTF-8") from None


def in_range(value, name, low, high):
    """NaN is outside every range."""
    require(low <= value <= high, "%s is out of range" % name)
    return value


LARGEST_F32 = (2 - 2.0 ** -23) * 2.0 ** 127
LEAST_F32 = 2.0 ** -149
