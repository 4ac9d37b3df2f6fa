#include "codec/common/lossless/number_set.h"

#include <algorithm>
#include <array>

namespace reeb {

namespace {

constexpr int kExactPowers = 23;  // 10^22 is the last power of ten that binary64 holds

constexpr std::array<double, kExactPowers> kPowers = [] {
  std::array<double, kExactPowers> powers{};
  double p = 1;
  for (double& out : powers) {
    out = p;
    p *= 10;
  }
  return powers;
}();

/// x * 10^power, |power| <= 22, rounded once.
double scale(double x, int power) {
  return power < 0 ? x / kPowers[static_cast<size_t>(-power)]
                   : x * kPowers[static_cast<size_t>(power)];
}

}  // namespace

NumberSet::NumberSet(uint32_t digits, uint32_t decimals)
    : digits_(digits),
      decimals_(decimals),
      first_(static_cast<uint64_t>(kPowers[digits])),
      later_(9 * (first_ / 10)) {
  // The largest number is below 10^22, so that all powers of ten in use are exact.
  const uint64_t decades = kExactPowers - 1 + decimals - digits;
  rank_end_ = static_cast<int64_t>(first_ + decades * later_);
}

NumberSet NumberSet::multiples(double step) {
  NumberSet out;
  out.step_ = step;
  out.rank_end_ = kMultiplesEnd;
  return out;
}

NumberSet NumberSet::levels(const FrameGrid& grid) {
  // Eighths of an octave from the bits of the step, which count as binary32's do.
  constexpr int kFractionBits = 52 - 3;
  constexpr int32_t kBiases = 8 * (1023 - 150);  // of binary64, and of the last place of binary32
  NumberSet out;
  out.step_ = grid.step;
  out.grid_ = grid;
  out.grid_spacing_ =
      static_cast<int32_t>(std::bit_cast<uint64_t>(grid.step) >> kFractionBits) - kBiases;
  return out;
}

NumberSet NumberSet::of_frames() {
  NumberSet out;
  out.by_frame_ = true;
  return out;
}

float NumberSet::level(uint32_t n) const {
  const NumberSet all;
  int64_t place = all.nearest(grid_.origin + n * step_);
  const auto at =
      std::lower_bound(grid_.corrections.begin(), grid_.corrections.end(), n,
                       [](const FrameGrid::Correction& c, uint32_t m) { return c.level < m; });
  if (at != grid_.corrections.end() && at->level == n) place += at->places;
  return all.number(place);
}

uint64_t NumberSet::decimal_rank(double x) const {
  const auto first = static_cast<double>(first_);
  const int places = static_cast<int>(decimals_);
  const int last = static_cast<int>(kExactPowers - 1 - digits_);  // exponent of the last decade
  int power = places;  // x is counted in units of 10^-power
  double k = scale(x, power);
  while (k + 0.5 >= first && power > -last) k = scale(x, --power);
  const double limit = k + 0.5 < first ? k + 0.5 : first - 0.5;
  const auto count = static_cast<uint64_t>(limit);
  if (power == places) return count;
  // Just below a power of ten the rounded count may lie one under the decade's first.
  const uint64_t lowest = first_ / 10;
  const auto passed = static_cast<uint64_t>(places - power - 1);
  return first_ + passed * later_ + (std::max(count, lowest) - lowest);
}

float NumberSet::decimal_number(uint64_t rank) const {
  const int power = decade(rank) - static_cast<int>(decimals_);
  const uint64_t count = rank < first_ ? rank : (rank - first_) % later_ + first_ / 10;
  return static_cast<float>(scale(static_cast<double>(count), power));
}

}  // namespace reeb
