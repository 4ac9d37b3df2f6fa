// Prediction of a frame's positions from the frame before and the neighbours that have moved
// already, with weights that follow each vertex through time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "codec/common/base/stop.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

struct DisplacementOptions {
  uint32_t neighbours = 14;  ///< at most so many predict a row, 0 .. 14
  uint32_t period = 1;       ///< after its first frames it learns from every period-th only
};

/// Rows are those of a surface graph. For every frame: `predict` and `place` row by row, then
/// `finish_frame`.
///
/// x_t(r) is predicted as x_t-1(r) + sum_i w_i y_i, the y being displacements x_t - x_t-1 of
/// neighbours and the row's own of the two frames before. The weights minimise the decaying sum
/// of squared errors of all frames and axes plus a ridge towards the ring's mean displacement. All
/// of it in binary64, in the order that spec/lossless.md fixes.
class DisplacementPredictor {
 public:
  /// `graph` must outlive the predictor; `start`: [row][xyz], the frame before the first.
  DisplacementPredictor(const PredictionGraph& graph, const std::vector<float>& start,
                        const DisplacementOptions& options, unsigned threads,
                        const StopToken& stop = {});
  ~DisplacementPredictor();
  DisplacementPredictor(const DisplacementPredictor&) = delete;
  DisplacementPredictor& operator=(const DisplacementPredictor&) = delete;

  /// World units.
  std::array<double, 3> predict(uint32_t row) const;
  /// The row's position before `place`, that of the frame before.
  const float* last(uint32_t row) const { return &position_[size_t{row} * 4]; }
  /// Sets the position of a row; `predicted` as `predict` gave it.
  void place(uint32_t row, const float xyz[3], const std::array<double, 3>& predicted);
  /// Learns from the frame.
  void finish_frame();
  /// Goes on from `frame` ([row][xyz]) as if it had just been coded, at rest.
  void jump(const std::vector<float>& frame);

 private:
  struct Batches;
  uint32_t terms(uint32_t row) const {
    return std::min<uint32_t>(graph_.rows[row].count, options_.neighbours);
  }
  bool learns() const;
  void learn();
  void solve();

  const PredictionGraph& graph_;
  DisplacementOptions options_;
  unsigned threads_;
  StopToken stop_;
  std::unique_ptr<Batches> batches_;
  std::vector<float> weights_;               ///< [row][kMaxNeighbours]
  std::vector<float> position_;              ///< [row][4], of the frame before or this one
  std::array<std::vector<float>, 3> moved_;  ///< [row][4], this frame and the two before
  std::vector<double> squared_error_;
  uint32_t frames_ = 0;  ///< finished ones
};

}  // namespace reeb
