// Differences of integers too many for a mixture of guesses: bit length around what is expected,
// sign, the bits below the leading one, of which the first two are modelled.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/common/lossless/rank_model.h"
#include "entropy/adaptive_bit.h"

namespace reeb {

class DifferenceModel {
 public:
  static constexpr uint32_t kLengths = 34;  ///< of magnitudes up to 2^33 - 1

  /// `expected`: the magnitude to expect, < 2^33.
  template <class Coder>
  int64_t code(Coder& coder, uint64_t expected, int64_t value) {
    const auto size = static_cast<uint64_t>(value < 0 ? -value : value);
    const auto wanted = static_cast<uint32_t>(std::bit_width(size));
    const auto at = std::min(static_cast<uint32_t>(std::bit_width(expected)), kLengths - 1);
    const uint32_t length =
        length_walk::code(8 * static_cast<int32_t>(at), [&](uint32_t least, uint32_t step) {
          return least < kLengths && lengths_[at][step].code(coder, wanted >= least, kLimit);
        });
    if (length == 0) return 0;
    const bool negative = sign_.code(coder, value < 0, kLimit);
    uint64_t coded = 1;
    for (uint32_t i = length - 1; i-- > 0;) {
      const bool bit = (size >> i & 1) != 0;
      const bool modelled = coded < 4;
      const bool got =
          modelled ? top_[length][coded].code(coder, bit, kLimit) : coder.code(bit, kEvenOdds);
      coded = coded << 1 | (got ? 1 : 0);
    }
    return negative ? -static_cast<int64_t>(coded) : static_cast<int64_t>(coded);
  }

 private:
  static constexpr uint32_t kLimit = 255;
  std::array<std::array<AdaptiveBit, length_walk::kSteps>, kLengths> lengths_;
  std::array<std::array<AdaptiveBit, 4>, kLengths> top_;
  AdaptiveBit sign_;
};

}  // namespace reeb
