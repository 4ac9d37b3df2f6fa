// Syntax of steps, and of the grid that a frame of a lossless group has along an axis.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "codec/common/lossless/frame_grid.h"
#include "codec/common/lossless/number_set.h"
#include "entropy/integer_coder.h"

namespace reeb {

template <class Raw>
double code_double(Raw& raw, double x) {
  const auto wanted = std::bit_cast<uint64_t>(x);
  const uint64_t low = raw.code(static_cast<uint32_t>(wanted), 32);
  const uint64_t high = raw.code(static_cast<uint32_t>(wanted >> 32), 32);
  return std::bit_cast<double>(high << 32 | low);
}

/// Codes a step; 0 where a decoder meets none.
template <class Raw>
double code_step(Raw& raw, double step) {
  const double coded = code_double(raw, step);
  constexpr auto kMax = static_cast<double>(std::numeric_limits<float>::max());
  return coded >= std::numeric_limits<double>::min() && coded <= kMax ? coded : 0;
}

/// The grids of the frames along one axis, one frame after another.
class GridSyntax {
 public:
  /// `grid`: of the frame before, or none; becomes this frame's. False where a decoder meets what
  /// no encoder writes.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, const FrameGrid& wanted, FrameGrid& grid) {
    if (same_.code(bits, wanted == grid)) return true;
    FrameGrid out;
    out.count = raw.code(wanted.count, 16);
    if (out.count > 0) {
      constexpr auto kMax = static_cast<double>(std::numeric_limits<float>::max());
      out.origin = code_double(raw, wanted.origin);
      out.step = code_step(raw, wanted.step);
      if (!(std::abs(out.origin) <= kMax) || out.step == 0) return false;
      if (!code_corrections(bits, wanted, out)) return false;
    }
    grid = std::move(out);
    return true;
  }

 private:
  // Each by the levels between it and the one before; one behind the last level ends them.
  template <class Bits>
  bool code_corrections(Bits& bits, const FrameGrid& wanted, FrameGrid& out) {
    uint64_t next = 0;
    for (size_t i = 0;; ++i) {
      const bool more = i < wanted.corrections.size();
      const uint64_t level = more ? wanted.corrections[i].level : out.count;
      next += gap_.code(bits, static_cast<uint32_t>(level - next));
      if (next >= out.count) return next == out.count;
      const auto n = static_cast<uint32_t>(next++);
      const uint32_t size = size_.code(bits, more ? size_of(wanted.corrections[i]) : 0);
      const bool down = down_.code(bits, more && wanted.corrections[i].places < 0);
      if (size >= kMaxSize) return false;
      const int32_t places = static_cast<int32_t>(size) + 1;
      out.corrections.push_back({n, down ? -places : places});
      if (!in_range(out, n)) return false;
    }
  }

  static uint32_t size_of(const FrameGrid::Correction& c) {
    return static_cast<uint32_t>(c.places < 0 ? -c.places : c.places) - 1;
  }
  /// True where the last level of a grid, which is corrected, is finite.
  static bool in_range(const FrameGrid& grid, uint32_t n) {
    const NumberSet all;
    return all.valid(all.nearest(grid.origin + n * grid.step) + grid.corrections.back().places);
  }

  static constexpr uint32_t kMaxSize = 1u << 30;

  AdaptiveBit same_;
  ExpGolombModel gap_, size_;
  AdaptiveBit down_;
};

}  // namespace reeb
