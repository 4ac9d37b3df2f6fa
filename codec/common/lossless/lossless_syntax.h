// Syntax of a lossless group around its frames: the sets of numbers, and frames that repeat.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "codec/common/lossless/frame_coder.h"
#include "entropy/integer_coder.h"

namespace reeb {

/// Codes a step; 0 where a decoder meets none.
template <class Raw>
double code_step(Raw& raw, double step) {
  const auto wanted = std::bit_cast<uint64_t>(step);
  const uint64_t low = raw.code(static_cast<uint32_t>(wanted), 32);
  const uint64_t high = raw.code(static_cast<uint32_t>(wanted >> 32), 32);
  const auto coded = std::bit_cast<double>(high << 32 | low);
  constexpr auto kMax = static_cast<double>(std::numeric_limits<float>::max());
  return coded >= std::numeric_limits<double>::min() && coded <= kMax ? coded : 0;
}

/// Codes the set of every axis; false where a decoder meets none.
template <class Raw>
bool code_number_sets(Raw& raw, NumberSets& sets) {
  for (NumberSet& set : sets) {
    constexpr uint32_t kMultiples = 15;  // in place of digits
    const uint32_t digits = raw.code(set.step() > 0 ? kMultiples : set.digits(), 4);
    if (digits == kMultiples) {
      const double step = code_step(raw, set.step());
      if (step == 0) return false;
      set = NumberSet::multiples(step);
      continue;
    }
    if (digits > NumberSet::kMaxDigits) return false;
    if (digits == 0) continue;
    const uint32_t decimals = raw.code(set.decimals(), 5);
    if (decimals > NumberSet::kMaxDecimals) return false;
    set = NumberSet(digits, decimals);
  }
  return true;
}

/// Which frames are copies of earlier ones of the group.
class RepeatSyntax {
 public:
  /// `distance`: frames back to the one that this frame repeats; 0 where it is coded itself.
  template <class Coder>
  uint32_t code(Coder& coder, uint32_t distance) {
    const bool repeats = repeats_[last_ > 0 ? 1 : 0].code(coder, distance > 0);
    if (!repeats) return last_ = 0;
    if (known_ > 0 && same_.code(coder, distance == known_)) return last_ = known_;
    known_ = distance_.code(coder, distance - 1) + 1;
    return last_ = known_;
  }

 private:
  AdaptiveBit repeats_[2];
  AdaptiveBit same_;
  ExpGolombModel distance_;
  uint32_t last_ = 0;   ///< of the frame before
  uint32_t known_ = 0;  ///< of the last frame that was a copy
};

}  // namespace reeb
