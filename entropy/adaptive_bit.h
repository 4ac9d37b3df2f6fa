// Adaptive probability of one binary context.
#pragma once

#include <array>
#include <cstdint>

#include "entropy/range_coder.h"

namespace reeb {

namespace detail {
/// Step of the n-th update in 1/65536: 1 / (n + 1.5), so that the first decisions count most.
inline constexpr auto kAdaptationRates = [] {
  std::array<uint32_t, 1024> rates{};
  for (uint32_t n = 0; n < rates.size(); ++n) rates[n] = (2u << 16) / (2 * n + 3);
  return rates;
}();
}  // namespace detail

/// Probability with 22 bits and the count of decisions seen with 10 bits.
class AdaptiveBit {
 public:
  /// 1 .. 65535, never certain.
  Probability p1() const {
    const uint32_t p = state_ >> 16;
    return static_cast<Probability>(p < 32 ? 32 : p > 65504 ? 65504 : p);
  }
  uint32_t count() const { return state_ & 0x3FF; }

  /// Learns `bit`; the rate falls to 1 / (limit + 1.5), limit 1 .. 1023.
  void update(bool bit, uint32_t limit) {
    const uint32_t n = count();
    const int64_t p = state_ >> 10;
    const int64_t target = bit ? (1 << 22) - 1 : 0;
    const int64_t next =
        p + (((target - p) * static_cast<int64_t>(detail::kAdaptationRates[n])) >> 16);
    state_ = static_cast<uint32_t>(next) << 10 | (n < limit ? n + 1 : n);
  }

  /// Codes and learns one bit.
  template <class Coder>
  bool code(Coder& coder, bool bit, uint32_t limit = 255) {
    const bool coded = coder.code(bit, p1());
    update(coded, limit);
    return coded;
  }

 private:
  uint32_t state_ = 1u << 31;
};

/// The same in 16 bits: rougher where it is almost certain, and quicker.
class ShortBit {
 public:
  /// 32 .. 65504.
  Probability p1() const { return p_ < 32 ? 32 : p_ > 65504 ? 65504 : p_; }

  /// Learns `bit`; the rate falls to 1 / (limit + 1.5), limit 1 .. 1023.
  void update(bool bit, uint32_t limit) {
    const int rate = static_cast<int>(detail::kAdaptationRates[count_] / 2);
    const int target = bit ? 65535 : 0;
    p_ = static_cast<uint16_t>(p_ + ((target - p_) * rate >> 15));
    if (count_ < limit) ++count_;
  }

 private:
  uint16_t p_ = 1u << 15;
  uint16_t count_ = 0;
};

}  // namespace reeb
