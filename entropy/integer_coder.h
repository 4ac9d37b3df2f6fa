// Binarization of integers over adaptive bits.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "entropy/adaptive_bit.h"

namespace reeb {

/// Codes the low `count` bits of a value at even odds, most significant first.
template <class Coder>
uint64_t code_evenly(Coder& coder, uint32_t count, uint64_t value) {
  uint64_t coded = 0;
  for (uint32_t i = count; i-- > 0;)
    coded = coded << 1 | (coder.code((value >> i & 1) != 0, kEvenOdds) ? 1u : 0u);
  return coded;
}

/// Codes a length, 0 .. more.size(), in unary: a bit of its own tells whether there is more.
template <class Coder>
uint32_t code_unary(Coder& coder, std::span<AdaptiveBit> more, uint32_t length,
                    uint32_t limit = 255) {
  uint32_t coded = 0;
  while (coded < more.size() && more[coded].code(coder, coded < length, limit)) ++coded;
  return coded;
}

/// Adaptive Exp-Golomb code of 0 .. 2^31-2: bit length of value+1 in unary, the bits below its
/// leading one with the top two modelled and the rest even.
class ExpGolombModel {
 public:
  template <class Coder>
  uint32_t code(Coder& coder, uint32_t value) {
    const uint32_t target = value + 1;  // meaningless, and unused, when decoding
    const auto wanted = static_cast<uint32_t>(std::bit_width(target)) - 1;
    const uint32_t length = code_unary(coder, length_, wanted);
    uint32_t coded = 1;
    for (uint32_t i = length; i-- > 0;) {
      const bool bit = (target >> i & 1) != 0;
      const bool modelled = length - i <= 2;
      const bool got =
          modelled ? top_[length][coded & 3].code(coder, bit) : coder.code(bit, kEvenOdds);
      coded = coded << 1 | (got ? 1 : 0);
    }
    return coded - 1;
  }

 private:
  static constexpr uint32_t kMaxLength = 30;
  std::array<AdaptiveBit, kMaxLength> length_;
  std::array<std::array<AdaptiveBit, 4>, kMaxLength + 1> top_;
};

/// Signed integer: zero and magnitude by Exp-Golomb, then an adaptive sign.
class SignedModel {
 public:
  template <class Coder>
  int32_t code(Coder& coder, int32_t value) {
    const uint32_t magnitude =
        magnitude_.code(coder, static_cast<uint32_t>(value < 0 ? -int64_t{value} : value));
    if (magnitude == 0) return 0;
    const bool negative = sign_.code(coder, value < 0);
    const auto signed_magnitude = static_cast<int32_t>(magnitude);
    return negative ? -signed_magnitude : signed_magnitude;
  }

 private:
  ExpGolombModel magnitude_;
  AdaptiveBit sign_;
};

}  // namespace reeb
