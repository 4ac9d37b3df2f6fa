// The arithmetic that finds the weights of lane fields, many rows at a time.
#pragma once

#include <cstdint>

#include "codec/common/prediction/prediction_graph.h"
#include "entropy/rans.h"

namespace reeb {

/// Of the first block.
inline constexpr uint32_t kFirstLanes = kRansLanes / 2;
inline constexpr uint32_t kPointStride = 4;
inline constexpr uint32_t kWeightRows = 16;

/// What the weights of a lane field's rows come from: the reference, and the values of blocks that
/// are decoded, [row][lane].
struct LaneWeightTask {
  const PredictionGraph::Row* rows = nullptr;
  const float* points = nullptr;        ///< [row][kPointStride]: x, y, z of the reference
  const float* values = nullptr;        ///< of the last block; null where there is none
  const uint32_t* history = nullptr;    ///< of wary fields, of each row: see LaneBlock
  const float* first_values = nullptr;  ///< of the first one, kFirstLanes a row; null where that is
                                        ///< the last
};

struct LaneWeightKernels {
  /// Weights of kWeightRows rows, the l-th's to out[l], as spec/fast.md, section 4, has it.
  void (*learn)(const LaneWeightTask&, const uint32_t* rows, float* const* out);
};

}  // namespace reeb
