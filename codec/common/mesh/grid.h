// Distances between vertices of the reference mesh, which lie on an integer grid.
#pragma once

#include <cstdint>
#include <span>

#include "codec/common/base/integer_math.h"

namespace reeb {

/// Positions of the reference mesh on its grid: [vertex][xyz], 0 .. 65535 each.
class GridPoints {
 public:
  explicit GridPoints(std::span<const int32_t> xyz) : xyz_(xyz) {}

  uint32_t size() const { return static_cast<uint32_t>(xyz_.size() / 3); }
  const int32_t* operator[](uint32_t v) const { return &xyz_[size_t{v} * 3]; }

  /// Squared distance in grid units.
  uint64_t distance2(uint32_t a, uint32_t b) const {
    uint64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
      const int64_t d = int64_t{(*this)[a][i]} - (*this)[b][i];
      sum += static_cast<uint64_t>(d * d);
    }
    return sum;
  }

  /// Distance in 1/16 grid units, rounded down.
  uint32_t distance_q4(uint32_t a, uint32_t b) const { return isqrt(distance2(a, b) << 8); }

 private:
  std::span<const int32_t> xyz_;
};

}  // namespace reeb
