// Syntax of a lossless group around its frames: the sets of numbers, and frames that repeat.
#pragma once

#include <algorithm>
#include <cstdint>

#include "codec/common/lossless/frame_coder.h"
#include "codec/common/lossless/grid_syntax.h"
#include "entropy/integer_coder.h"

namespace reeb {

/// Codes the set of every axis; false where a decoder meets none.
template <class Raw>
bool code_number_sets(Raw& raw, NumberSets& sets) {
  for (NumberSet& set : sets) {
    constexpr uint32_t kMultiples = 15, kByFrame = 14;  // in place of digits
    const uint32_t wanted = set.step() > 0 ? kMultiples : set.by_frame() ? kByFrame : set.digits();
    const uint32_t digits = raw.code(wanted, 4);
    if (digits == kByFrame) {
      set = NumberSet::of_frames();
      continue;
    }
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
