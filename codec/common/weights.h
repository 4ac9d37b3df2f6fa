// Prediction weights that learn while decoding: for every row of a field, ridge least squares over
// everything decoded so far (the reference positions and all earlier components), re-solved on a
// thinning schedule.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/batches.h"
#include "codec/common/grid.h"
#include "codec/common/kernels.h"
#include "codec/common/prediction_graph.h"

namespace reeb {

struct WeightOptions {
  double ring_deviation = 1.2;    ///< prior standard deviation of a ring neighbour's weight
  double extra_deviation = 0.84;  ///< of any other neighbour's
  bool sum_to_one = true;         ///< weights reproduce constants
};

/// Weights minimise sum_o (sum_i w_i y_oi - t_o)^2 / noise_o + sum_i (w_i - prior_i)^2 /
/// deviation_i^2. All of it in binary64, in the order that spec/prediction.md fixes, rounded once
/// to binary32.
///
/// A row that its weights have predicted without error keeps them: what it has observed since
/// agrees with them, so that they are the minimum still. The others are *stale*.
class WeightEstimator {
 public:
  /// `graph` must outlive the estimator. `threads` >= 1; the weights do not depend on it.
  WeightEstimator(const PredictionGraph& graph, const WeightOptions& options, unsigned threads);
  WeightEstimator(const WeightEstimator& other) = default;
  WeightEstimator& operator=(const WeightEstimator&) = delete;

  /// Learns from the reference positions, taken as exact to half a grid unit and to the surface's
  /// bending, and solves for all rows. `order[row]` is the row's point. Pre-condition: nothing is
  /// observed yet.
  void observe_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Starts a component to learn from.
  void begin_component();

  /// The row's value in the component being decoded, and whether it was predicted `exactly`: a row
  /// that was not becomes stale.
  void note(uint32_t row, float value, bool exactly) {
    values_[size_t{row} * kObservations + observations_] = value;
    if (!exactly) stale_[row] = 1;
  }

  /// Learns from the component, all of whose rows are noted and whose residuals had the given
  /// variance.
  void finish_component(double noise);

  /// Lets all that is observed count `factor` times as much; all rows become stale.
  void fade(double factor);

  /// Brings the weights of stale rows up to date; at first all are.
  void solve();

  /// kMaxNeighbours weights of a row; 0 for padding.
  const float* weights(uint32_t row) const { return &weights_[size_t{row} * kMaxNeighbours]; }

 private:
  void make_equations();
  void fold(uint32_t row);
  /// For rows[first] and the seven after it.
  void solve(const std::vector<uint32_t>& rows, uint32_t first);

  const PredictionGraph& graph_;
  WeightOptions options_;
  unsigned threads_;
  Kernels kernels_ = fastest_kernels();
  BatchVector<RowEquations> equations_;  ///< none before something is learned
  std::vector<RowTarget> targets_;       ///< none where weights sum to one
  std::vector<float> values_;            ///< [row][observation]: the last ones
  double scale_[kObservations] = {};     ///< 1 / sqrt(noise) of each
  uint32_t observations_ = 0;            ///< that are in `values_`
  std::vector<uint8_t> folded_;          ///< of these, those in the row's equations
  std::vector<uint8_t> stale_;
  std::vector<float> weights_;
};

/// True where the weights are re-solved after component k: every one at first, then ever fewer.
constexpr bool resolve_after(uint32_t k) {
  if (k < 4) return true;
  if (k < 16) return k % 2 == 1;
  if (k < 64) return k % 4 == 3;
  return k % 16 == 15;
}

}  // namespace reeb
