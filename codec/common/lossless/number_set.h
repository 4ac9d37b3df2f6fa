// The numbers that a coordinate may be, in order, each with an integer: what lossless coding
// predicts and takes differences of.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "codec/common/lossless/frame_grid.h"

namespace reeb {

/// Every binary32 value; or the decimals of `digits` significant digits and at most `decimals`
/// places, each rounded to binary32: what text files hold; or the multiples of a step, rounded to
/// binary32: what is left where errors up to half of it are allowed; or the levels of a grid.
///
/// The integer of a number x >= 0 is its rank, that of -x is -1 - rank; 0 and -0 differ. That of a
/// multiple is how many steps it is, that of a level its number.
class NumberSet {
 public:
  static constexpr uint32_t kMaxDigits = 9;
  static constexpr uint32_t kMaxDecimals = 22;
  /// Ranks, and distances of two of them, stay below 2 to this power.
  static constexpr uint32_t kRankBits = 40;

  /// Every binary32 value.
  NumberSet() = default;
  /// Decimals; 1 <= digits <= kMaxDigits, decimals <= kMaxDecimals.
  NumberSet(uint32_t digits, uint32_t decimals);
  /// Multiples; `step` is positive and at most the largest binary32.
  static NumberSet multiples(double step);

  /// The levels of a grid, which has some.
  static NumberSet levels(const FrameGrid& grid);
  /// In place of a set: every frame brings its own.
  static NumberSet of_frames();

  /// 0 but for multiples and levels.
  double step() const { return step_; }
  bool by_frame() const { return by_frame_; }
  bool decimal() const { return digits_ > 0; }
  uint32_t digits() const { return digits_; }
  uint32_t decimals() const { return decimals_; }

  /// The integer of the number next to x, which is finite; beyond binary32 the largest.
  int64_t nearest(double x) const {
    if (step_ > 0) return grid_.count > 0 ? nearest_level(x) : nearest_multiple(x);
    const bool negative = std::signbit(x);
    const auto rank = static_cast<int64_t>(decimal() ? decimal_rank(negative ? -x : x)
                                                     : binary_rank(negative ? -x : x));
    return negative ? -1 - rank : rank;
  }

  /// The integer of a member, `found` false where x is none.
  int64_t find(float x, bool& found) const {
    const int64_t n = nearest(static_cast<double>(x));
    found = valid(n) && std::bit_cast<uint32_t>(number(n)) == std::bit_cast<uint32_t>(x);
    return n;
  }

  /// What takes the integer `from` to `to`, which are those of numbers; levels follow each other in
  /// a ring, so that it is at most half their count.
  int64_t difference(int64_t from, int64_t to) const {
    const int64_t count = grid_.count, d = to - from;
    if (count == 0) return d;
    return d > count / 2 ? d - count : d < -(count / 2) ? d + count : d;
  }
  int64_t moved(int64_t from, int64_t difference) const {
    const int64_t count = grid_.count, n = from + difference;
    return count == 0 ? n : (n % count + count) % count;
  }

  /// True where the integer is that of a finite number.
  bool valid(int64_t n) const {
    if (grid_.count > 0) return n >= 0 && n < int64_t{grid_.count};
    const int64_t rank = n < 0 ? -1 - n : n;
    return rank < rank_end_ && (step_ == 0 || std::isfinite(number(n)));
  }

  /// The number of a valid integer.
  float number(int64_t n) const {
    if (grid_.count > 0) return level(static_cast<uint32_t>(n));
    if (step_ > 0) return static_cast<float>(static_cast<double>(n) * step_);
    const auto rank = static_cast<uint64_t>(n < 0 ? -1 - n : n);
    const float x =
        decimal() ? decimal_number(rank) : std::bit_cast<float>(static_cast<uint32_t>(rank));
    return n < 0 ? -x : x;
  }

  /// log2 of the distance between neighbours near a valid integer, in 1/8, up to a constant.
  int32_t spacing(int64_t n) const {
    if (step_ > 0) return grid_.count > 0 ? grid_spacing_ : 0;
    const auto rank = static_cast<uint64_t>(n < 0 ? -1 - n : n);
    return decimal() ? decade(rank) * 213 / 8 : 8 * static_cast<int32_t>(rank >> 23);
  }

 private:
  static constexpr int64_t kBinaryEnd = 0x7F800000;
  static constexpr int64_t kMultiplesEnd = int64_t{1} << (kRankBits - 1);

  static uint64_t binary_rank(double x) {
    constexpr double kMaxFloat = std::numeric_limits<float>::max();
    return std::bit_cast<uint32_t>(static_cast<float>(x < kMaxFloat ? x : kMaxFloat));
  }
  /// floor(x / step + 1/2), within the ranks.
  int64_t nearest_multiple(double x) const {
    const double n = std::floor(x / step_ + 0.5);
    constexpr auto kMax = static_cast<double>(kMultiplesEnd - 1);
    return static_cast<int64_t>(n > kMax ? kMax : n < -kMax ? -kMax : n);
  }
  /// floor((x - origin) / step + 1/2), within the levels.
  int64_t nearest_level(double x) const {
    const double n = std::floor((x - grid_.origin) / step_ + 0.5);
    const double last = grid_.count - 1;
    return static_cast<int64_t>(n > last ? last : n < 0 ? 0 : n);
  }
  float level(uint32_t n) const;
  uint64_t decimal_rank(double x) const;
  float decimal_number(uint64_t rank) const;
  /// How often the distance has grown tenfold up to a rank.
  int32_t decade(uint64_t rank) const {
    return rank < first_ ? 0 : static_cast<int32_t>((rank - first_) / later_) + 1;
  }

  double step_ = 0;
  FrameGrid grid_;
  int32_t grid_spacing_ = 0;
  bool by_frame_ = false;
  uint32_t digits_ = 0;
  uint32_t decimals_ = 0;
  int64_t rank_end_ = kBinaryEnd;
  uint64_t first_ = 0;  ///< ranks of the first decade, 10^digits
  uint64_t later_ = 1;  ///< ranks of each later decade, 9 * 10^(digits - 1)
};

}  // namespace reeb
