#include "codec/common/synthesis/synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace reeb {

GroupSynthesis::GroupSynthesis(ComponentSum sum, std::vector<double> mean)
    : sum_(std::move(sum)), mean_(std::move(mean)) {}

GroupSynthesis::GroupSynthesis(std::vector<std::vector<float>> planes, const float axis_step[3],
                               const float origin[3], std::span<const uint32_t> output)
    : planes_(std::move(planes)), output_(output) {
  std::copy_n(axis_step, 3, axis_step_);
  for (size_t row = 0; row < planes_.size(); ++row)
    mean_.push_back(static_cast<double>(origin[row % 3]));
}

bool GroupSynthesis::finite() const {
  return std::all_of(mean_.begin(), mean_.end(), [](double x) { return std::isfinite(x); }) &&
         sum_.finite();
}

void GroupSynthesis::direct_frame(uint32_t t, float* xyz, size_t stride) const {
  for (uint32_t a = 0; a < 3; ++a) {
    const std::vector<float>& plane = planes_[size_t{t} * 3 + a];
    const double mean = mean_[size_t{t} * 3 + a];
    for (size_t r = 0; r < plane.size(); ++r)
      xyz[output_[r] * stride + a] =
          static_cast<float>(mean + static_cast<double>(axis_step_[a] * plane[r]));
  }
}

void GroupSynthesis::frames(uint32_t first, uint32_t count, float* xyz, size_t frame_stride,
                            size_t stride) const {
  const bool exact = exact_.frame_count() > 0;
  if (!exact && planes_.empty()) sum_.frames(first, count, mean_.data(), xyz, frame_stride, stride);
  for (uint32_t i = 0; i < count; ++i) {
    float* frame = xyz + i * frame_stride;
    if (exact) exact_.frame(first + i, output_, frame, stride);
    if (!planes_.empty()) direct_frame(first + i, frame, stride);
    corrections_.apply(first + i, frame, stride);
  }
}

// Several planes at a time, since each addition waits for the one before.
std::vector<double> plane_norms(const std::vector<std::vector<float>>& planes) {
  constexpr size_t kAtOnce = 8;
  std::vector<double> out;
  for (size_t k = 0; k < planes.size(); k += kAtOnce) {
    const size_t count = std::min(kAtOnce, planes.size() - k);
    std::array<const float*, kAtOnce> plane;
    for (size_t i = 0; i < kAtOnce; ++i) plane[i] = planes[k + std::min(i, count - 1)].data();
    std::array<double, kAtOnce> sum{};
    for (size_t r = 0; r < planes[k].size(); ++r) {
      for (size_t i = 0; i < kAtOnce; ++i) {
        const auto x = static_cast<double>(plane[i][r]);
        sum[i] += x * x;
      }
    }
    for (size_t i = 0; i < count; ++i) out.push_back(std::sqrt(sum[i]));
  }
  return out;
}

GroupSynthesis synthesize(std::vector<std::vector<float>> planes,
                          const std::vector<std::vector<float>>& basis_planes,
                          const std::vector<uint32_t>& basis_order, double q, const float origin[3],
                          std::span<const uint32_t> output) {
  const size_t rows = basis_order.size();
  std::vector<double> mean(rows);
  const double mean_scale = q / std::sqrt(static_cast<double>(output.size()));
  for (size_t r = 0; r < rows; ++r) {
    const double moved = static_cast<double>(basis_planes[0][r]) * mean_scale;
    mean[basis_order[r]] = static_cast<double>(origin[basis_order[r] % 3]) + moved;
  }
  const std::vector<double> norms = plane_norms(planes);
  std::vector<std::vector<double>> basis(planes.size(), std::vector<double>(rows));
  for (size_t k = 0; k < planes.size(); ++k) {
    const double scale = norms[k] > 0 ? 1 / norms[k] : 0;
    const std::vector<float>& coded = basis_planes[k + 1];
    for (size_t r = 0; r < rows; ++r)
      basis[k][basis_order[r]] = static_cast<double>(coded[r]) * scale;
  }
  return {ComponentSum(std::move(planes), basis, q, output), std::move(mean)};
}

}  // namespace reeb
