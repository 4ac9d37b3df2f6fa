#include "codec/common/fast/lane_weights.h"

#include <algorithm>
#include <numeric>

#include "codec/common/simd/instruction_set.h"

namespace reeb {

LaneStart lane_start(const SurfaceGraph& surface, const GridPoints& points, const StopToken& stop) {
  const uint32_t rows = surface.graph.size();
  LaneStart out;
  out.points.resize((size_t{rows} + 1) * kPointStride);
  for (size_t r = 0; r < rows; ++r) {
    const int32_t* const p = points[surface.order[r]];
    for (size_t a = 0; a < 3; ++a) out.points[r * kPointStride + a] = static_cast<float>(p[a]);
  }
  out.weights.resize(size_t{rows} * kMaxNeighbours);
  std::vector<uint32_t> all(rows);
  std::iota(all.begin(), all.end(), 0u);
  learn_weights({.rows = surface.graph.rows.data(), .points = out.points.data()}, all, out.weights,
                stop);
  return out;
}

void learn_weights(const LaneWeightTask& task, std::span<const uint32_t> rows,
                   std::vector<float>& weights, const StopToken& stop) {
  const LaneWeightKernels& kernels = fastest_kernels<LaneWeightKernels>();
  for (size_t first = 0; first < rows.size(); first += kWeightRows) {
    stop.check();
    uint32_t row[kWeightRows];
    float* out[kWeightRows];
    for (size_t l = 0; l < kWeightRows; ++l) {
      row[l] = rows[std::min(first + l, rows.size() - 1)];  // past the end, the last once more
      out[l] = &weights[size_t{row[l]} * kMaxNeighbours];
    }
    kernels.learn(task, row, out);
  }
}

}  // namespace reeb
