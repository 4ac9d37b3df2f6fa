// Context-mixing model of the differences that lossless coding leaves: bit length by decisions
// around what is expected, sign, the bits below the leading one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/common/base/integer_math.h"
#include "codec/common/lossless/number_set.h"
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
  uint32_t coarseness = 0;   ///< 0 .. 7, from the finest rows to the coarsest
  int32_t sign_before = 0;   ///< of the row's difference in the frame before
  int32_t sign_nearest = 0;  ///< of the first two neighbours' in this frame
  int32_t sign_next = 0;
};

/// Bit lengths are found by decisions whether they reach a length, upwards or downwards from the
/// one expected.
namespace length_walk {
/// Lengths below are of differences; this one stands for a number that is none of the set.
inline constexpr uint32_t kEscape = NumberSet::kRankBits + 2;
inline constexpr uint32_t kSteps = 17;  ///< decisions told apart, by distance from the first
inline constexpr uint32_t kFirst = 8;   ///< the first decision's

/// `reaches(length, step)` codes whether the length is at least `length`.
template <class Reaches>
uint32_t code(int32_t expected, Reaches reaches) {
  auto length = static_cast<uint32_t>(std::clamp((expected + 4) / 8, 1, int32_t{kEscape} - 1));
  uint32_t step = kFirst;
  if (reaches(length, step)) {
    while (length < kEscape && reaches(length + 1, step = std::min(step + 1, kSteps - 1))) ++length;
    return length;
  }
  do {
    --length;
  } while (length > 0 && !reaches(length, step = std::max(step, 1u) - 1));
  return length;
}
}  // namespace length_walk

/// Codes a difference by its bit length, `code_length(wanted)`, and what tells it from others of
/// that length, `code_rest(length, size)`. True, and `n` is it, unless a number outside the set
/// follows.
template <class CodeLength, class CodeRest>
bool code_by_length(bool escape, int64_t& n, CodeLength code_length, CodeRest code_rest) {
  const auto size = static_cast<uint64_t>(n < 0 ? -n : n);
  const uint32_t length =
      code_length(escape ? length_walk::kEscape : static_cast<uint32_t>(std::bit_width(size)));
  if (length == length_walk::kEscape) return false;
  n = length == 0 ? 0 : code_rest(length, size);
  return true;
}

/// The low `count` (0 .. 41) bits of a size, as raw bits.
template <class Raw>
uint64_t code_raw(Raw& raw, uint64_t size, uint32_t count) {
  uint64_t coded = 0;
  while (count > 0) {
    const uint32_t part = std::min(count, 24u);
    count -= part;
    coded =
        coded << part | raw.code(static_cast<uint32_t>(size >> count & ((1u << part) - 1)), part);
  }
  return coded;
}

class RankModel {
 public:
  RankModel();

  /// Codes and learns a difference; see code_by_length.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, const DifferenceContext& c, bool escape, int64_t& n) {
    const auto length = [&](uint32_t wanted) { return code_length(bits, c, wanted); };
    const auto rest = [&](uint32_t bit_length, uint64_t size) {
      const bool negative = sign_[sign_context(c)].code(bits, n < 0, kSignLimit);
      const auto coded = static_cast<int64_t>(code_places(bits, raw, c, bit_length, size));
      return negative ? -coded : coded;
    };
    return code_by_length(escape, n, length, rest);
  }

 private:
  static constexpr int kTables = 6;
  static constexpr uint32_t kTopPlaces = 3;  ///< bits below the leading one that are modelled
  static constexpr uint32_t kTableLimit = 250;
  static constexpr uint32_t kSignLimit = 250;
  static constexpr uint32_t kPlaceLimit = 1000;
  static constexpr uint32_t kSteps = length_walk::kSteps;
  using Mixer = BitMixer<kTables>;

  static std::array<uint32_t, kTables> table_sizes();
  /// First entries of the context in each table.
  static std::array<uint32_t, kTables> entries(const DifferenceContext& c);
  static uint32_t sign_context(const DifferenceContext& c) {
    return static_cast<uint32_t>((c.sign_before + 1) * 9 + (c.sign_nearest + 1) * 3 + c.sign_next +
                                 1);
  }

  template <class Bits>
  uint32_t code_length(Bits& bits, const DifferenceContext& c, uint32_t wanted) {
    const std::array<uint32_t, kTables> base = entries(c);
    return length_walk::code(c.expected, [&](uint32_t length, uint32_t step) {
      std::array<uint32_t, kTables> entry;
      for (int i = 0; i < kTables; ++i) entry[i] = base[i] + step;
      const Mixer::Prediction made = mixer_.predict(entry, step * 3 + c.axis);
      const bool bit = bits.code(wanted >= length, made.p1);
      mixer_.update(made, bit);
      return bit;
    });
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
    return uint64_t{node} << left | code_raw(raw, size, left);
  }

  static constexpr uint32_t kShapes = 5;
  Mixer mixer_;
  AdaptiveBit sign_[27];
  AdaptiveBit places_[8][kShapes][1 << kTopPlaces];
};

/// The same differences for the quick method: bit lengths by one context, all else raw.
class QuickRankModel {
 public:
  /// See RankModel::code.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, const DifferenceContext& c, bool escape, int64_t& n) {
    auto& models = lengths_[std::min<uint32_t>(static_cast<uint32_t>(c.expected) / 2, kSizes - 1)];
    const auto length = [&](uint32_t wanted) {
      return length_walk::code(c.expected, [&](uint32_t least, uint32_t step) {
        return models[step].code(bits, wanted >= least, kLimit);
      });
    };
    const auto rest = [&](uint32_t bit_length, uint64_t size) {
      // The sign stands where the leading one would.
      const uint64_t one = uint64_t{1} << (bit_length - 1);
      const uint64_t coded = code_raw(raw, n < 0 ? size : size - one, bit_length);
      return coded >= one ? -static_cast<int64_t>(coded) : static_cast<int64_t>(coded + one);
    };
    return code_by_length(escape, n, length, rest);
  }

 private:
  static constexpr uint32_t kSizes = 160;  ///< expected sizes told apart, in quarters of bits
  static constexpr uint32_t kLimit = 500;
  std::array<std::array<AdaptiveBit, length_walk::kSteps>, kSizes> lengths_;
};

}  // namespace reeb
