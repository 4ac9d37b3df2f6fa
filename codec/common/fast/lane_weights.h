// Weights that predict the coefficients of the fast profile: found from the reference mesh, then,
// for the rows that need it, once more from the first blocks of components.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/fast/lane_weight_kernels.h"
#include "codec/common/mesh/grid.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// What the fields of all groups on a reference mesh start from.
struct LaneStart {
  std::vector<float> points;   ///< kPointStride a row: its vertex on the grid; padded at the end
  std::vector<float> weights;  ///< kMaxNeighbours a row; 0 for padding

  static uint64_t bytes(uint64_t rows) {
    return (rows * (kPointStride + kMaxNeighbours) + kPointStride) * sizeof(float);
  }
};
LaneStart lane_start(const SurfaceGraph& surface, const GridPoints& points,
                     const StopToken& stop = {});

/// Finds the weights of `rows` anew; see LaneWeightTask. Throws Stopped where
/// `stop` is requested.
void learn_weights(const LaneWeightTask& task, std::span<const uint32_t> rows,
                   std::vector<float>& weights, const StopToken& stop = {});

}  // namespace reeb
