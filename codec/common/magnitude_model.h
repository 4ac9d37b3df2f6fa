// Context-mixing model of quantized residuals: unary magnitude with an Exp-Golomb escape, then the
// sign.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "entropy/mixer.h"

namespace reeb {

/// What is known of a residual before it is coded, in 1/256 of its own quantization step.
struct Surroundings {
  uint32_t ring_mean = 0;     ///< mean magnitude of the ring in this component
  uint32_t ring_max = 0;      ///< largest magnitude of the ring in this component
  uint32_t history = 0;       ///< decaying mean of the row's magnitudes in earlier components
  uint32_t ring_history = 0;  ///< the same, averaged over the rows linked to it
  uint32_t running = 0;       ///< decaying mean over the rows coded just before
  uint32_t level = 0;         ///< 0 .. 7, from the finest rows to the coarsest
  uint32_t component = 0;
};

class MagnitudeModel {
 public:
  static constexpr uint32_t kBins = 18;  ///< unary decisions; the last one announces an escape
  static constexpr uint64_t kMaxMagnitude = (uint64_t{1} << 56) - 1;

  using Mixer = BitMixer<6>;

  /// Table entries that the surroundings choose.
  struct Context {
    std::array<uint32_t, 6> base;
    uint32_t weight_set = 0;
    uint32_t escape = 0;
  };

  /// Predictions for the unary decisions of one residual, made when first asked for.
  class Bins {
   public:
    Bins(const MagnitudeModel& model, const Surroundings& s)
        : model_(model), context_(context(s)) {}

    const Mixer::Prediction& operator[](uint32_t i) {
      for (; made_ <= i; ++made_) bins_[made_] = model_.predict(context_, made_);
      return bins_[i];
    }
    uint32_t escape() const { return context_.escape; }

   private:
    const MagnitudeModel& model_;
    Context context_;
    std::array<Mixer::Prediction, kBins> bins_;
    uint32_t made_ = 0;
  };

  MagnitudeModel();

  /// The next magnitude down that has a code: past kMantissaBits the low bits are not coded, so
  /// that a far outlier costs little more than binary32 can tell of it.
  static uint64_t representable(uint64_t magnitude) {
    if (magnitude < kBins) return magnitude;
    const uint64_t target = magnitude - kBins + 1;
    const int dropped = std::max(0, static_cast<int>(std::bit_width(target)) - 1 - kMantissaBits);
    return (target >> dropped << dropped) + kBins - 1;
  }

  /// Codes and learns a residual of representable magnitude, |value| <= kMaxMagnitude.
  template <class Coder>
  int64_t code(Coder& coder, Bins& bins, int64_t value) {
    const auto wanted = static_cast<uint64_t>(value < 0 ? -value : value);
    uint32_t unary = 0;
    while (unary < kBins) {
      const Mixer::Prediction& bin = bins[unary];
      const bool more = coder.code(unary < wanted, bin.p1);
      mixer_.update(bin, more);
      if (!more) break;
      ++unary;
    }
    if (unary == 0) return 0;
    uint64_t magnitude = unary;
    if (unary == kBins) magnitude += code_escape(coder, bins.escape(), wanted - kBins);
    const bool negative = coder.code(value < 0, kEvenOdds);
    const auto signed_magnitude = static_cast<int64_t>(magnitude);
    return negative ? -signed_magnitude : signed_magnitude;
  }

 private:
  static constexpr uint32_t kEscapeClasses = 8;
  static constexpr uint32_t kEscapeLengths = 56;
  static constexpr int kMantissaBits = 24;
  static constexpr uint32_t kEscapeLimit = 30;

  static Context context(const Surroundings& s);
  Mixer::Prediction predict(const Context& c, uint32_t bin) const;

  template <class Coder>
  uint64_t code_escape(Coder& coder, uint32_t escape_class, uint64_t excess) {
    const uint64_t target = excess + 1;
    const auto wanted = static_cast<uint32_t>(std::bit_width(target)) - 1;
    auto& lengths = escape_[escape_class];
    uint32_t length = 0;
    while (length < kEscapeLengths - 1 &&
           lengths[length].code(coder, length < wanted, kEscapeLimit))
      ++length;
    uint64_t coded = 1;
    for (uint32_t i = length; i-- > 0;) {
      const bool sent = i + kMantissaBits >= length;
      coded = coded << 1 | (sent && coder.code((target >> i & 1) != 0, kEvenOdds) ? 1u : 0u);
    }
    return coded - 1;
  }

  Mixer mixer_;
  std::array<std::array<AdaptiveBit, kEscapeLengths>, kEscapeClasses> escape_;
};

}  // namespace reeb
