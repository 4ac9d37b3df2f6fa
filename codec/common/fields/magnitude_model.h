// Context-mixing model of quantized residuals: bucket of the magnitude in unary with an Exp-Golomb
// escape, place in the bucket, sign.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/common/base/coding_tools.h"
#include "entropy/buckets.h"
#include "entropy/integer_coder.h"
#include "entropy/mixer.h"

namespace reeb {

using MagnitudeBuckets = Buckets<4>;

/// What is known of a residual before it is coded: magnitudes in 1/256 of the quantization step q.
struct Surroundings {
  uint32_t ring_mean = 0;    ///< of the ring in this component
  uint32_t extra_mean = 0;   ///< of the neighbours beyond the ring
  uint32_t recent = 0;       ///< decaying mean over the rows coded just before
  uint32_t history = 0;      ///< decaying mean of the row's own ones in earlier components
  uint32_t last = 0;         ///< the row's own one in the previous component
  uint32_t step = 1u << 16;  ///< of the row, in 1/65536 of q
  uint64_t inverse_step = uint64_t{1} << 34;  ///< 2^50 / step, rounded up

  /// Sixteen times the magnitude to expect.
  uint32_t expected() const { return 3 * ring_mean + 2 * extra_mean + 3 * recent + 8 * history; }
};

class MagnitudeModel {
 public:
  static constexpr uint32_t kBins = 24;  ///< magnitude buckets; what is beyond them escapes
  static constexpr uint32_t kEscapeBegin = MagnitudeBuckets::begin(kBins);
  static constexpr uint64_t kMaxMagnitude = (uint64_t{1} << 56) - 1;

  static constexpr int kTables = 4;
  using Mixer = BitMixer<kTables, ShortBit>;

  /// Where little is expected, whether it is 0 is one adaptive bit, by how much is expected; else,
  /// and beyond, bits are mixed.
  static constexpr uint32_t kCalmClasses = 4;
  static uint32_t calm_class(const Surroundings& s) {
    const uint32_t expected = s.expected();
    const uint32_t unit = s.step >> 8;
    uint32_t out = 0;
    for (uint32_t c = 1; c <= kCalmClasses; ++c) out += expected >= c * unit ? 1 : 0;
    return out;
  }

  /// Decisions that a bucket is found by. Each asks whether the bucket is beyond some other.
  static constexpr uint32_t kNodes = 2 * kBins;
  static constexpr uint32_t kCalmNode = kNodes;  ///< is not mixed

  /// Where the tables begin that the surroundings choose.
  struct Context {
    std::array<uint32_t, kTables> table;
    uint32_t escape;
    bool unsure;  ///< much is expected, and little known of how much
  };

  /// Predictions for the decisions of one residual, made when first asked for.
  class Bins {
   public:
    Bins(const MagnitudeModel& model, const Surroundings& s)
        : model_(model), around_(s), calm_(MagnitudeModel::calm_class(s)) {}

    uint32_t calm_class() const { return calm_; }

    /// Finds a bucket: `decide(node, b)` tells whether it is beyond b. In unary; where it is
    /// unsure, by fours first.
    template <class Decide>
    uint32_t find(Decide decide) {
      const bool calm = calm_ < kCalmClasses;
      if (calm && !decide(kCalmNode, 0)) return 0;
      if (made_ == 0) context_ = context(around_);
      if (context_.unsure) return find_unsure(decide);
      uint32_t b = calm ? 1 : 0;
      while (b < kBins && decide(b, b)) ++b;
      return b;
    }

    /// Probability that the answer is yes.
    Probability p1(uint32_t node) {
      return node == kCalmNode ? model_.calm_[calm_].p1() : mixed(node).p1;
    }

    /// node < kNodes.
    const Mixer::Prediction& mixed(uint32_t node) {
      if ((made_ >> node & 1) == 0) made_predictions_[node] = model_.predict(context_, node);
      made_ |= uint64_t{1} << node;
      return made_predictions_[node];
    }
    /// Pre-condition: `find` found a bucket beyond 0.
    uint32_t escape() const { return context_.escape; }

   private:
    template <class Decide>
    static uint32_t find_unsure(Decide decide) {
      uint32_t four = 0;
      while (four < kBins && decide(kBins + four, four + 3)) four += 4;
      if (four == kBins) return kBins;
      const uint32_t node = kBins + four;
      const bool upper = decide(node + 1, four + 1);
      const uint32_t two = upper ? four + 2 : four;
      return decide(node + (upper ? 3 : 2), two) ? two + 1 : two;
    }

    const MagnitudeModel& model_;
    const Surroundings& around_;
    uint32_t calm_;
    uint64_t made_ = 0;  ///< a bit for each node
    Context context_;
    std::array<Mixer::Prediction, kNodes> made_predictions_;
  };

  MagnitudeModel();

  /// The next magnitude down that has a code: past kMantissaBits the low bits are not coded, so
  /// that a far outlier costs little more than binary32 can tell of it.
  static uint64_t representable(uint64_t magnitude) {
    if (magnitude < kEscapeBegin) return magnitude;
    const uint64_t target = magnitude - kEscapeBegin + 1;
    const auto length = static_cast<uint32_t>(std::bit_width(target)) - 1;
    const uint32_t dropped = std::max(length, kMantissaBits) - kMantissaBits;
    return (target >> dropped << dropped) + kEscapeBegin - 1;
  }

  /// Codes and learns a residual of representable magnitude, |value| <= kMaxMagnitude.
  template <class Coder>
  int64_t code(Coder& coder, Bins& bins, int64_t value) {
    const auto wanted = static_cast<uint64_t>(value < 0 ? -value : value);
    const uint32_t wanted_bucket = std::min(kBins, MagnitudeBuckets::of(wanted));
    const uint32_t b = bins.find([&](uint32_t node, uint32_t than) {
      if (node == kCalmNode) return calm_[bins.calm_class()].code(coder, wanted_bucket > than);
      const Mixer::Prediction& made = bins.mixed(node);
      const bool bit = coder.code(wanted_bucket > than, made.p1);
      mixer_.update(made, bit);
      return bit;
    });
    if (b == 0) return 0;
    const uint64_t within = wanted - MagnitudeBuckets::begin(b);
    const uint64_t magnitude =
        MagnitudeBuckets::begin(b) +
        (b < kBins ? code_evenly(coder, MagnitudeBuckets::extra_bits(b), within)
                   : code_escape(coder, bins.escape(), within));
    const bool negative = coder.code(value < 0, kEvenOdds);
    const auto signed_magnitude = static_cast<int64_t>(magnitude);
    return negative ? -signed_magnitude : signed_magnitude;
  }

 private:
  static constexpr uint32_t kEscapeClasses = 8;
  static constexpr uint32_t kMaxEscapeLength = 55;
  static constexpr uint32_t kMantissaBits = 24;
  static constexpr uint32_t kEscapeLimit = 30;

  // Contexts of each table.
  static constexpr std::array<uint32_t, kTables> kContexts = {12 * 12, 24, 8 * 12, 12 * 12};
  static constexpr uint32_t kUnsureClass = 10;  ///< of the 24 of table 1
  static constexpr uint32_t kAdaptationLimit = 40;

  static Context context(const Surroundings& s);
  Mixer::Prediction predict(const Context& c, uint32_t node) const {
    std::array<uint32_t, kTables> entries;
    for (uint32_t i = 0; i < kTables; ++i) entries[i] = c.table[i] + node;
    Mixer::Prediction made = mixer_.predict(entries, node);
    if (!uses(coding_tool::kMixing)) made.p1 = squash(made.input[0]);
    return made;
  }

  template <class Coder>
  uint64_t code_escape(Coder& coder, uint32_t escape_class, uint64_t excess) {
    const uint64_t target = excess + 1;
    const auto wanted = static_cast<uint32_t>(std::bit_width(target)) - 1;
    const uint32_t length = code_unary(coder, escape_[escape_class], wanted, kEscapeLimit);
    const uint32_t dropped = std::max(length, kMantissaBits) - kMantissaBits;
    const uint64_t mantissa = code_evenly(coder, length - dropped, target >> dropped);
    return ((uint64_t{1} << length) | mantissa << dropped) - 1;
  }

  std::array<AdaptiveBit, kCalmClasses> calm_;
  Mixer mixer_;
  std::array<std::array<AdaptiveBit, kMaxEscapeLength>, kEscapeClasses> escape_;
};

}  // namespace reeb
