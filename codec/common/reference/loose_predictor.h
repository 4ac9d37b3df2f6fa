// Guesses of the grid positions of vertices without triangles, from those just before.
#pragma once

#include <array>
#include <cstdint>

#include "codec/common/reference/guess_mixture.h"

namespace reeb {

class LoosePredictor {
 public:
  static constexpr uint32_t kMemory = 256;  ///< observations, see GuessMixture
  static constexpr uint32_t kKindCount = 3 * 3;

  /// Axes in turn, `learn` after each `guess`.
  void guess(size_t axis, GuessMixture& out) const;
  void learn(size_t axis, int32_t value);
  /// Where to look first, and how far around it (see GuessMixture::code).
  uint32_t likely(size_t axis) const { return static_cast<uint32_t>(past_[axis][0]); }
  uint32_t reach(size_t axis) const { return 1 + static_cast<uint32_t>(step_[axis]) / 16; }

 private:
  static constexpr size_t kPast = 3;
  std::array<std::array<int32_t, kPast>, 3> past_{};  // by axis, latest first
  std::array<int32_t, 3> step_{};                     // smoothed size of steps by axis, 1/16
};

}  // namespace reeb
