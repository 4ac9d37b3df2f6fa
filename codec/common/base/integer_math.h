// Exact integer functions that steer orders and contexts; identical on every machine.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace reeb {

/// floor(sqrt(n)) for n < 2^52. IEEE-754 square roots are correctly rounded, so truncation is
/// exact.
inline uint32_t isqrt(uint64_t n) {
  return static_cast<uint32_t>(std::sqrt(static_cast<double>(n)));
}

/// log2(x) in units of 1/32, x >= 1: the exponent, then the next five bits of x (linear in
/// between).
inline uint32_t log2_q5(uint64_t x) {
  const auto msb = static_cast<uint32_t>(std::bit_width(x | 1)) - 1;
  const uint64_t fraction = msb >= 5 ? x >> (msb - 5) : x << (5 - msb);
  return msb * 32 + static_cast<uint32_t>(fraction & 31);
}

}  // namespace reeb
