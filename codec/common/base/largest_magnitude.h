// Largest magnitude of many values.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace reeb {

/// 0 of none; infinite or no number where one of the values is. Magnitudes of binary32 are in the
/// order of their bits, and maxima of integers are what compilers vectorise.
inline float largest_magnitude(std::span<const float> values) {
  int32_t bits = 0;
  for (const float x : values)
    bits = std::max(bits, std::bit_cast<int32_t>(x) & int32_t{0x7FFFFFFF});
  return std::bit_cast<float>(bits);
}

}  // namespace reeb
