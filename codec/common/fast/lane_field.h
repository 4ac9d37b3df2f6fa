// Coding of a field in the fast profile: sixteen components at a time, row after row, with weights
// that are fixed within them. A row's components do not depend on each other, so they are predicted
// in one vector and decoded by as many interleaved coders. Encoder and decoder run this same code.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/stop.h"
#include "codec/common/fast/lane_kernels.h"
#include "codec/common/fast/lane_weights.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/simd/instruction_set.h"
#include "entropy/rans.h"

namespace reeb {

/// How many of `count` components the block has that starts with component k. The first block is
/// small, since nothing is known of the rows before it.
constexpr uint32_t lanes_of_block(uint32_t k, uint32_t count) {
  return std::min(k == 0 ? kFirstLanes : kRansLanes, count - k);
}

class LaneField {
 public:
  using Planes = std::vector<std::vector<float>>;

  /// `weights`: kMaxNeighbours a row, 0 beyond its neighbours. Graph and weights must outlive the
  /// field.
  LaneField(const PredictionGraph& graph, std::span<const float> weights);
  /// A field of coefficients, which learns from its first blocks; where it is `wary`, the less the
  /// worse a row was predicted. `start` must outlive it.
  LaneField(const PredictionGraph& graph, const LaneStart& start, bool wary);

  LaneField(LaneField&&) = default;
  LaneField(const LaneField&) = delete;  // the block points into its field

  /// Starts the next block. Throws Stopped where `stop` is requested.
  void begin_block(const StopToken& stop = {});
  /// What the row's neighbours tell of the row.
  LaneGuess guess(uint32_t row) const { return kernels_.guess(block_, row); }
  /// Takes the row's residuals, the guess being that of `guess`.
  void note(uint32_t row, const LaneGuess& guess, const int32_t* residuals) {
    kernels_.note(block_, row, guess, residuals);
  }
  /// All rows of a block at once, `lanes` components of them.
  void decode_rows(RansDecoder& decoder, uint32_t lanes) {
    kernels_.decode(block_, decoder, lanes);
  }
  /// Ends the block and appends its first `lanes` components.
  void end_block(uint32_t lanes, Planes& planes);

  /// In units of the quantization step.
  float step(uint32_t row) const { return steps_[row]; }
  uint32_t rows() const { return graph_.size(); }

 private:
  /// Finds new weights for the rows that were predicted badly.
  void learn(const StopToken& stop);
  void keep_first_values();

  const PredictionGraph& graph_;
  const LaneStart* start_ = nullptr;  ///< where weights are learned
  bool wary_ = false;
  LaneKernels kernels_ = fastest_kernels<LaneKernels>();
  std::vector<float> steps_;
  std::vector<float> weights_;  ///< once any are learned
  std::vector<float> values_;
  std::vector<float> first_values_;  ///< of the first block, once learned from; kFirstLanes a row
  std::vector<uint16_t> magnitudes_;
  std::vector<uint32_t> history_;
  uint32_t blocks_ = 0;  ///< that are complete
  LaneBlock block_;
};

/// Decodes a section of `components` planes; false where it is damaged, or `stop` is requested.
bool decode_lane_field(std::span<const uint8_t> section, uint32_t components, LaneField& field,
                       LaneField::Planes& planes, const StopToken& stop = {});

/// The priors of a graph as weights.
std::vector<float> prior_weights(const PredictionGraph& graph);

}  // namespace reeb
