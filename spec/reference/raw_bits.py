"""lossless.md, and fast.md section 1: raw bits."""
from .errors import require


class RawBits:
    def __init__(self, data):
        self.data = data
        self.position = 0  # in bits

    def raw(self, count):
        value = 0
        for i in range(count):
            byte = self.position // 8
            require(byte < len(self.data), "raw bits are read past their end")
            value |= (self.data[byte] >> (self.position % 8) & 1) << i
            self.position += 1
        return value

    def check_end(self):
        left = 8 * len(self.data) - self.position
        require(left < 8 and self.raw(left) == 0, "raw bits are left")
