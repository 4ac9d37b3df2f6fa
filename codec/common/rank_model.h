// Context-mixing model of the differences that lossless coding leaves: bit length by decisions
// around what is expected, sign, the bits below the leading one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/common/integer_math.h"
#include "codec/common/number_set.h"
#include "entropy/mixer.h"

namespace reeb {

/// Size of a difference as contexts see it: log2(1 + |n|) in 1/8.
inline int32_t log_size(int64_t n) {
  const auto size = static_cast<uint64_t>(n < 0 ? -n : n);
  return static_cast<int32_t>(log2_q5(size + 1) / 4);
}

/// What is known of a difference before it is coded. Sizes are as of `log_size`, of differences in
/// the same unit; signs are -1, 0 or 1.
struct DifferenceContext {
  int32_t expected = 0;      ///< a mean of the sizes below, at least 0
  int32_t before = 0;        ///< of the row's difference in the frame before, this axis
  int32_t older = 0;         ///< in the frame before that
  int32_t ring = 0;          ///< mean over neighbours in this frame
  int32_t nearest = 0;       ///< of the first neighbour in this frame
  int32_t axis_before = 0;   ///< of the row's axis before this one, or of recent rows
  uint32_t axis = 0;         ///< 0 .. 2
  uint32_t level = 0;        ///< 0 .. 7, from the finest rows to the coarsest
  int32_t sign_before = 0;   ///< of the row's difference in the frame before
  int32_t sign_nearest = 0;  ///< of the first two neighbours' in this frame
  int32_t sign_next = 0;
};

class RankModel {
 public:
  /// Bit lengths 0 .. kLengths - 1 are of differences; kEscape stands for a number that is none of
  /// the set.
  static constexpr uint32_t kEscape = NumberSet::kRankBits + 2;

  RankModel();

  /// Codes and learns a difference; true, and `n` is it, unless a number outside the set follows.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, const DifferenceContext& c, bool escape, int64_t& n) {
    const auto size = static_cast<uint64_t>(n < 0 ? -n : n);
    const auto wanted = escape ? kEscape : static_cast<uint32_t>(std::bit_width(size));
    const uint32_t length = code_length(bits, c, wanted);
    if (length == kEscape) return false;
    if (length == 0) {
      n = 0;
      return true;
    }
    const bool negative = sign_[sign_context(c)].code(bits, n < 0, kSignLimit);
    const uint64_t coded = code_places(bits, raw, c, length, size);
    n = negative ? -static_cast<int64_t>(coded) : static_cast<int64_t>(coded);
    return true;
  }

 private:
  static constexpr int kTables = 6;
  static constexpr uint32_t kSteps = 17;     ///< decisions told apart, by distance from the first
  static constexpr uint32_t kFirst = 8;      ///< the first decision's
  static constexpr uint32_t kTopPlaces = 3;  ///< bits below the leading one that are modelled
  static constexpr uint32_t kTableLimit = 250;
  static constexpr uint32_t kSignLimit = 250;
  static constexpr uint32_t kPlaceLimit = 1000;
  using Mixer = BitMixer<kTables>;

  static std::array<uint32_t, kTables> table_sizes();
  /// First entries of the context in each table.
  static std::array<uint32_t, kTables> entries(const DifferenceContext& c);
  static uint32_t sign_context(const DifferenceContext& c) {
    return static_cast<uint32_t>((c.sign_before + 1) * 9 + (c.sign_nearest + 1) * 3 + c.sign_next +
                                 1);
  }
  static uint32_t guess(const DifferenceContext& c) {
    return static_cast<uint32_t>(std::clamp((c.expected + 4) / 8, 1, int32_t{kEscape} - 1));
  }

  template <class Bits>
  uint32_t code_length(Bits& bits, const DifferenceContext& c, uint32_t wanted) {
    const std::array<uint32_t, kTables> base = entries(c);
    const uint32_t first = guess(c);
    const auto reaches = [&](uint32_t length, uint32_t step) {
      std::array<uint32_t, kTables> entry;
      for (int i = 0; i < kTables; ++i) entry[i] = base[i] + step;
      const Mixer::Prediction made = mixer_.predict(entry, step * 3 + c.axis);
      const bool bit = bits.code(wanted >= length, made.p1);
      mixer_.update(made, bit);
      return bit;
    };
    uint32_t length = first;
    uint32_t step = kFirst;
    if (reaches(length, step)) {
      while (length < kEscape && reaches(length + 1, step = std::min(step + 1, kSteps - 1)))
        ++length;
      return length;
    }
    do {
      --length;
    } while (length > 0 && !reaches(length, step = std::max(step, 1u) - 1));
    return length;
  }

  template <class Bits, class Raw>
  uint64_t code_places(Bits& bits, Raw& raw, const DifferenceContext& c, uint32_t length,
                       uint64_t size) {
    const auto shape = static_cast<uint32_t>(
        std::clamp((c.expected + 4) / 8 - static_cast<int32_t>(length) + 4, 0, 7));
    auto& places = places_[shape][std::min(length, kShapes - 1)];
    uint32_t left = length - 1;
    uint32_t node = 1;
    for (; left > 0 && node < 1u << kTopPlaces; --left) {
      const bool bit = places[node].code(bits, (size >> (left - 1) & 1) != 0, kPlaceLimit);
      node = node << 1 | (bit ? 1 : 0);
    }
    uint64_t coded = uint64_t{node} << left;
    for (; left > 0;) {
      const uint32_t count = std::min(left, 24u);
      left -= count;
      coded |= uint64_t{raw.code(static_cast<uint32_t>(size >> left & ((1u << count) - 1)), count)}
               << left;
    }
    return coded;
  }

  static constexpr uint32_t kShapes = 5;
  Mixer mixer_;
  AdaptiveBit sign_[27];
  AdaptiveBit places_[8][kShapes][1 << kTopPlaces];
};

}  // namespace reeb
