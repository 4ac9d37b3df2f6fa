#include "codec/common/synthesis/component_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "codec/common/base/largest_magnitude.h"

namespace reeb {

namespace {

constexpr float kPlaneUnits = 64;      // of a narrow plane's integers, per quantization step
constexpr double kBasisUnits = 32768;  // of a narrow basis vector's
constexpr int64_t kMax16 = 32767;
constexpr int64_t kMaxSum = INT32_MAX;
constexpr uint32_t kFramesAtOnce = 16;  // while a tile is at hand

/// Ties to even; |x| < 2^22.
int32_t round_to_integer(float x) {
  constexpr float kRound = 12582912.0f;  // 3 * 2^22: leaves no fraction
  return std::bit_cast<int32_t>(x + kRound) - std::bit_cast<int32_t>(kRound);
}

/// Largest magnitude among the rounded values, or more than kMax16.
int64_t largest_integer(const std::vector<float>& plane) {
  const float largest = largest_magnitude(plane) * kPlaneUnits;
  return largest < static_cast<float>(kMax16 + 1) ? round_to_integer(largest) : kMax16 + 1;
}

int64_t largest_integer(const std::vector<double>& basis) {
  double largest = 0;
  for (const double x : basis) {
    if (!(std::abs(x) * kBasisUnits < static_cast<double>(kMax16 + 1))) return kMax16 + 1;
    largest = std::max(largest, std::abs(x));
  }
  return std::llrint(largest * kBasisUnits);
}

uint32_t pack(int32_t first, int32_t second) {
  return (static_cast<uint32_t>(first) & 0xFFFF) | static_cast<uint32_t>(second) << 16;
}

int32_t unpack(uint32_t pair, uint32_t which) { return static_cast<int16_t>(pair >> (16 * which)); }

}  // namespace

ComponentSum::ComponentSum(Planes planes, const std::vector<std::vector<double>>& basis, double q,
                           std::span<const uint32_t> output)
    : vertices_(static_cast<uint32_t>(output.size())),
      unit_(static_cast<float>(q / (static_cast<double>(kPlaneUnits) * kBasisUnits))) {
  choose_narrow(planes, basis);
  fill_basis(basis, q);
  fill_tiles(planes, output);
}

// As many as there is room for in a sum of 32 bits, from the last component on.
void ComponentSum::choose_narrow(const Planes& planes,
                                 const std::vector<std::vector<double>>& basis) {
  wide_ = static_cast<uint32_t>(planes.size());
  for (int64_t room = kMaxSum; wide_ > 0; --wide_, ++narrow_) {
    const int64_t size = largest_integer(planes[wide_ - 1]);
    const int64_t share = size <= kMax16 ? largest_integer(basis[wide_ - 1]) : 0;
    if (std::max(size, share) > kMax16 || size * share > room) break;
    room -= size * share;
  }
}

void ComponentSum::fill_basis(const std::vector<std::vector<double>>& basis, double q) {
  const size_t rows = basis.empty() ? 0 : basis[0].size();
  wide_basis_.resize(rows * wide_);
  narrow_basis_.resize(rows * pairs());
  for (uint32_t k = 0; k < wide_; ++k) {
    for (size_t row = 0; row < rows; ++row)
      wide_basis_[row * wide_ + k] = static_cast<float>(basis[k][row] * q);
  }
  for (uint32_t i = 0; i < narrow_; ++i) {
    for (size_t row = 0; row < rows; ++row) {
      const auto x = static_cast<int32_t>(std::llrint(basis[wide_ + i][row] * kBasisUnits));
      narrow_basis_[row * pairs() + i / 2] |= i % 2 == 0 ? pack(x, 0) : pack(0, x);
    }
  }
}

// Planes are used up one after another, so as not to be in memory twice.
void ComponentSum::fill_tiles(Planes& planes, std::span<const uint32_t> output) {
  const size_t tiles = (vertices_ + kTileRows - 1) / kTileRows;
  std::vector<uint32_t> row_of(tiles * kTileRows, 0);  // what pads the last tile is never read
  for (uint32_t r = 0; r < vertices_; ++r) row_of[output[r]] = r;
  const auto fill = [&](auto& out, uint32_t count, uint32_t i, const auto& values) {
    for (size_t tile = 0; tile < tiles; ++tile) {
      const uint32_t* rows = &row_of[tile * kTileRows];
      auto* to = &out[(tile * count + i) * kTileRows];
      for (uint32_t j = 0; j < kTileRows; ++j) to[j] = values[rows[j]];
    }
  };
  wide_tiles_.resize(tiles * kTileRows * wide_);
  narrow_tiles_.resize(tiles * kTileRows * pairs());
  for (uint32_t k = 0; k < wide_; ++k) fill(wide_tiles_, wide_, k, std::exchange(planes[k], {}));
  std::vector<uint32_t> words(vertices_);
  for (uint32_t i = 0; i < narrow_; i += 2) {
    const std::vector<float> first = std::exchange(planes[wide_ + i], {});
    const std::vector<float> second =
        i + 1 < narrow_ ? std::exchange(planes[wide_ + i + 1], {}) : std::vector<float>(vertices_);
    for (uint32_t r = 0; r < vertices_; ++r)
      words[r] =
          pack(round_to_integer(first[r] * kPlaneUnits), round_to_integer(second[r] * kPlaneUnits));
    fill(narrow_tiles_, pairs(), i / 2, words);
  }
}

double ComponentSum::basis(size_t row, uint32_t component) const {
  if (component < wide_) return static_cast<double>(wide_basis_[row * wide_ + component]);
  const uint32_t i = component - wide_;
  return unpack(narrow_basis_[row * pairs() + i / 2], i % 2) * static_cast<double>(kPlaneUnits) *
         static_cast<double>(unit_);
}

bool ComponentSum::finite() const {
  return std::isfinite(unit_) && std::all_of(wide_basis_.begin(), wide_basis_.end(),
                                             [](float x) { return std::isfinite(x); });
}

void ComponentSum::frames(uint32_t first, uint32_t count, const double* mean, float* xyz,
                          size_t frame_stride, size_t stride) const {
  float apart[3 * kTileRows];
  for (uint32_t at = 0; at < count; at += kFramesAtOnce) {
    const uint32_t end = std::min(count, at + kFramesAtOnce);
    for (uint32_t v = 0; v < vertices_; v += kTileRows) {
      const uint32_t rows = std::min(kTileRows, vertices_ - v);
      const ComponentTile tile = {wide_tiles_.data() + size_t{v} * wide_, wide_,
                                  narrow_tiles_.data() + size_t{v} * pairs(), pairs()};
      for (uint32_t t = at; t < end; ++t) {
        const size_t row = 3 * (size_t{first} + t);
        const FrameBasis basis = {wide_basis_.data() + row * wide_,
                                  narrow_basis_.data() + row * pairs(), unit_, mean + row};
        float* to = xyz + t * frame_stride + v * stride;
        const bool joined = stride == 3 && rows == kTileRows;
        kernels_.combine(tile, basis, joined ? to : apart);
        for (uint32_t i = 0; !joined && i < rows; ++i)
          std::copy_n(apart + 3 * i, 3, to + i * stride);
      }
    }
  }
}

}  // namespace reeb
