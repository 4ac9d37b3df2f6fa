// Logistic mixing of adaptive probabilities from several context tables, in integers throughout
// (the method of the PAQ family of compressors).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"

namespace reeb {

/// Logistic domain: units of 1/256, stretch(p) = ln(p / (1 - p)).
inline constexpr int kStretchLimit = 2047;     ///< inputs lie in +-8
inline constexpr int kSquashLimit = 12 * 256;  ///< mixed values lie in +-12

namespace detail {
extern const std::array<Probability, 2 * kSquashLimit + 1> kSquash;
extern const std::array<int16_t, 4096> kStretch;
}  // namespace detail

/// round(65536 / (1 + exp(-x / 256))) clamped to 1 .. 65535; |x| <= kSquashLimit.
inline Probability squash(int x) {
  return detail::kSquash[static_cast<uint32_t>(x + kSquashLimit)];
}

/// Inverse of squash on 4096 equal intervals of p, |result| <= kStretchLimit.
inline int stretch(Probability p) { return detail::kStretch[p >> 4]; }

/// Mixes N context tables for one binary decision. The caller names one entry of each table and a
/// set of mixing weights; `predict` leaves the model as it is, so that an encoder may ask for many
/// costs. `Bit` is the entry of a table: AdaptiveBit or ShortBit.
template <int N, class Bit = AdaptiveBit>
class BitMixer {
 public:
  struct Prediction {
    std::array<uint32_t, N> entry;
    std::array<int, N> input;
    uint32_t weight_set;
    Probability p1;
  };

  BitMixer(const std::array<uint32_t, N>& table_sizes, uint32_t weight_sets, uint32_t limit)
      : weights_(size_t{weight_sets} * N, kUnit * 11 / 10 / N), limit_(limit) {
    for (int i = 0; i < N; ++i) tables_[i].resize(table_sizes[i]);
  }

  Prediction predict(const std::array<uint32_t, N>& entries, uint32_t weight_set) const {
    Prediction out;
    out.entry = entries;
    out.weight_set = weight_set;
    const int32_t* w = &weights_[size_t{weight_set} * N];
    int64_t dot = 0;
    for (int i = 0; i < N; ++i) {
      out.input[i] = stretch(tables_[i][entries[i]].p1());
      dot += int64_t{w[i]} * out.input[i];
    }
    const int64_t x = dot >> 16;
    out.p1 = squash(static_cast<int>(x < -kSquashLimit  ? -kSquashLimit
                                     : x > kSquashLimit ? kSquashLimit
                                                        : x));
    return out;
  }

  void update(const Prediction& made, bool bit) {
    const int error = (bit ? 65535 : 0) - static_cast<int>(made.p1);
    int32_t* w = &weights_[size_t{made.weight_set} * N];
    for (int i = 0; i < N; ++i) {
      w[i] += (made.input[i] * error + (1 << (kRateShift - 1))) >> kRateShift;
      tables_[i][made.entry[i]].update(bit, limit_);
    }
  }

 private:
  static constexpr int32_t kUnit = 1 << 16;
  static constexpr int kRateShift = 16;

  std::array<std::vector<Bit>, N> tables_;
  std::vector<int32_t> weights_;
  uint32_t limit_;
};

}  // namespace reeb
