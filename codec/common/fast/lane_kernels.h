// The arithmetic of lane fields: prediction and decoding of a row's components, all at once.
#pragma once

#include <cstdint>

#include "codec/common/prediction/prediction_graph.h"
#include "entropy/rans.h"

namespace reeb {

/// What the kernels see of a LaneField: a block of components of all rows.
struct LaneBlock {
  const PredictionGraph::Row* rows = nullptr;
  const float* weights = nullptr;     ///< kMaxNeighbours a row
  const float* steps = nullptr;       ///< of each row
  const uint32_t* history = nullptr;  ///< of each row, in 1/16; null in the first block
  float* values = nullptr;            ///< [row][lane]
  uint16_t* magnitudes = nullptr;     ///< [row][lane]
  uint32_t running[kRansLanes] = {};  ///< decaying means of the magnitudes, in 1/256
  uint32_t before[kRansLanes] = {};   ///< the same without the last row
  uint32_t row_count = 0;
};

/// Prediction and context class of a row's components.
struct LaneGuess {
  float prediction[kRansLanes];
  uint32_t cls[kRansLanes];
};

struct LaneKernels {
  LaneGuess (*guess)(const LaneBlock&, uint32_t row);
  /// Takes the residuals n of a row.
  void (*note)(LaneBlock&, uint32_t row, const LaneGuess&, const int32_t* n);
  /// Decodes all rows of the first `lanes` components.
  void (*decode)(LaneBlock&, RansDecoder&, uint32_t lanes);
};

}  // namespace reeb
