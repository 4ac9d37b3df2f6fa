#include "codec/common/synthesis.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {

GroupSynthesis::GroupSynthesis(std::vector<std::vector<float>> planes,
                               const std::vector<std::vector<float>>& basis,
                               std::vector<double> mean)
    : component_count_(static_cast<uint32_t>(planes.size())), mean_(std::move(mean)) {
  const size_t k_count = planes.size();
  const size_t rows = planes.empty() ? 0 : planes[0].size();
  tiles_.resize((rows + kTileRows - 1) / kTileRows * kTileRows * k_count, 0.0f);
  for (size_t k = 0; k < k_count; ++k) {
    for (size_t row = 0; row < rows; ++row)
      tiles_[(row / kTileRows * k_count + k) * kTileRows + row % kTileRows] = planes[k][row];
    planes[k] = {};  // not twice in memory
  }
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

void GroupSynthesis::tile_positions(uint32_t t, uint32_t first, uint32_t count,
                                    float (*out)[kTileRows]) const {
  const double* mean = &mean_[size_t{t} * 3];
  if (!direct_) {
    const float* tile = tiles_.data() + size_t{first} * component_count_;
    const float* scale = basis_.data() + size_t{t} * 3 * component_count_;
    kernels_.combine(tile, component_count_, scale, mean, out);
    return;
  }
  for (uint32_t a = 0; a < 3; ++a) {
    const float* plane = planes_[size_t{t} * 3 + a].data() + first;
    for (uint32_t i = 0; i < count; ++i)
      out[a][i] = static_cast<float>(mean[a] + static_cast<double>(basis_[a] * plane[i]));
  }
}

void GroupSynthesis::frame(uint32_t t, std::span<const uint32_t> output, float* xyz,
                           size_t stride) const {
  if (exact_.frame_count() > 0) return exact_.frame(t, output, xyz, stride);
  const auto rows = static_cast<uint32_t>(output.size());
  float tile[3][kTileRows];
  for (uint32_t first = 0; first < rows; first += kTileRows) {
    const uint32_t count = std::min(kTileRows, rows - first);
    tile_positions(t, first, count, tile);
    for (uint32_t i = 0; i < count; ++i) {
      float* p = xyz + output[first + i] * stride;
      for (uint32_t a = 0; a < 3; ++a) p[a] = tile[a][i];
    }
  }
  corrections_.apply(t, output, xyz, stride);
}

double plane_norm(const std::vector<float>& plane) {
  double sum = 0;
  for (const float x : plane) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum);
}

GroupSynthesis synthesize(uint32_t vertices, std::vector<std::vector<float>> planes,
                          const std::vector<std::vector<float>>& basis_planes,
                          const std::vector<uint32_t>& basis_order, double q,
                          const float origin[3]) {
  const size_t rows = basis_order.size();
  std::vector<double> mean(rows);
  const double mean_scale = q / std::sqrt(static_cast<double>(vertices));
  for (size_t r = 0; r < rows; ++r) {
    const double moved = static_cast<double>(basis_planes[0][r]) * mean_scale;
    mean[basis_order[r]] = static_cast<double>(origin[basis_order[r] % 3]) + moved;
  }
  std::vector<std::vector<float>> basis(planes.size(), std::vector<float>(rows));
  for (size_t k = 0; k < planes.size(); ++k) {
    const double norm = plane_norm(planes[k]);
    const double scale = norm > 0 ? q / norm : 0;
    const std::vector<float>& coded = basis_planes[k + 1];
    for (size_t r = 0; r < rows; ++r) {
      basis[k][basis_order[r]] = static_cast<float>(static_cast<double>(coded[r]) * scale);
    }
  }
  return GroupSynthesis(std::move(planes), basis, std::move(mean));
}

}  // namespace reeb
