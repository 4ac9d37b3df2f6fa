#include "codec/common/synthesis.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {

GroupSynthesis::GroupSynthesis(std::vector<std::vector<float>> planes,
                               const std::vector<std::vector<float>>& basis,
                               std::vector<double> mean)
    : planes_(std::move(planes)), mean_(std::move(mean)) {
  const size_t k_count = planes_.size();
  basis_.resize(mean_.size() * k_count);
  for (size_t k = 0; k < k_count; ++k) {
    for (size_t row = 0; row < mean_.size(); ++row) basis_[row * k_count + k] = basis[k][row];
  }
}

GroupSynthesis::GroupSynthesis(std::vector<std::vector<float>> planes, const float axis_step[3],
                               const float origin[3])
    : planes_(std::move(planes)), basis_(axis_step, axis_step + 3), direct_(true) {
  for (size_t row = 0; row < planes_.size(); ++row)
    mean_.push_back(static_cast<double>(origin[row % 3]));
}

bool GroupSynthesis::finite() const {
  return std::all_of(mean_.begin(), mean_.end(), [](double x) { return std::isfinite(x); }) &&
         std::all_of(basis_.begin(), basis_.end(), [](float x) { return std::isfinite(x); });
}

void GroupSynthesis::sum_components(uint32_t t, const float* const* planes, uint32_t count,
                                    float* const sum[3]) const {
  const auto plane_count = static_cast<uint32_t>(planes_.size());
  if (!direct_) {
    const float* scale = basis_.data() + size_t{t} * 3 * plane_count;
    kernels_.combine(planes, plane_count, scale, count, sum);
    return;
  }
  for (uint32_t a = 0; a < 3; ++a) {
    const float* plane = planes[size_t{t} * 3 + a];
    for (uint32_t i = 0; i < count; ++i) sum[a][i] = basis_[a] * plane[i];
  }
}

void GroupSynthesis::frame(uint32_t t, std::span<const uint32_t> output, float* xyz,
                           size_t stride) const {
  if (exact_.frame_count() > 0) return exact_.frame(t, output, xyz, stride);
  const auto rows = static_cast<uint32_t>(output.size());
  const double* mean = &mean_[size_t{t} * 3];
  float x[kBlock], y[kBlock], z[kBlock];
  float* const sum[3] = {x, y, z};
  std::vector<const float*> planes;
  for (const std::vector<float>& plane : planes_) planes.push_back(plane.data());
  for (uint32_t begin = 0; begin < rows; begin += kBlock) {
    const uint32_t count = std::min(kBlock, rows - begin);
    sum_components(t, planes.data(), count, sum);
    for (uint32_t i = 0; i < count; ++i) {
      float* p = xyz + output[begin + i] * stride;
      for (uint32_t a = 0; a < 3; ++a)
        p[a] = static_cast<float>(mean[a] + static_cast<double>(sum[a][i]));
    }
    for (const float*& plane : planes) plane += count;
  }
  corrections_.apply(t, output, xyz, stride);
}

double plane_norm(const std::vector<float>& plane) {
  double sum = 0;
  for (const float x : plane) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum);
}

GroupSynthesis synthesize(uint32_t vertices, std::vector<std::vector<float>> planes,
                          const Field& basis_field, const std::vector<uint32_t>& basis_order,
                          double q, const float origin[3]) {
  const size_t rows = basis_order.size();
  std::vector<double> mean(rows);
  const double mean_scale = q / std::sqrt(static_cast<double>(vertices));
  for (size_t r = 0; r < rows; ++r) {
    const double moved = static_cast<double>(basis_field.plane(0)[r]) * mean_scale;
    mean[basis_order[r]] = static_cast<double>(origin[basis_order[r] % 3]) + moved;
  }
  std::vector<std::vector<float>> basis(planes.size(), std::vector<float>(rows));
  for (size_t k = 0; k < planes.size(); ++k) {
    const double norm = plane_norm(planes[k]);
    const double scale = norm > 0 ? q / norm : 0;
    const std::vector<float>& coded = basis_field.plane(static_cast<uint32_t>(k) + 1);
    for (size_t r = 0; r < rows; ++r) {
      basis[k][basis_order[r]] = static_cast<float>(static_cast<double>(coded[r]) * scale);
    }
  }
  return GroupSynthesis(std::move(planes), basis, std::move(mean));
}

}  // namespace reeb
