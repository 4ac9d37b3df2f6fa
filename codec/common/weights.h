// Prediction weights that learn while decoding: for every row of a field, ridge least squares over
// everything decoded so far (the reference positions and all earlier components), re-solved where
// predictions failed.
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
/// agrees with them, so that they are the minimum still. A component in which a row erred is a
/// *miss* of its weights.
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

  /// The row's value in the component being decoded, and whether it was predicted `exactly`, which
  /// is no miss.
  void note(uint32_t row, float value, bool exactly) {
    values_[size_t{row} * kObservations + observations_] = value;
    if (!exactly && misses_[row] < kNeverSolved) ++misses_[row];
  }

  /// Learns from the component, all of whose rows are noted and whose residuals had the given
  /// variance.
  void finish_component(double noise);

  /// Lets all that is observed count `factor` times as much; all rows count as never solved
  /// for.
  void fade(double factor);

  /// Brings the weights of rows up to date that have had as many misses since they were last solved
  /// for, up to 254, or that never were.
  void solve(uint32_t misses);

  /// kMaxNeighbours weights of a row; 0 for padding.
  const float* weights(uint32_t row) const { return &weights_[size_t{row} * kMaxNeighbours]; }

 private:
  void make_equations();
  void fold(uint32_t row);
  /// For rows[first] and the seven after it.
  void solve_eight(const std::vector<uint32_t>& rows, uint32_t first);

  static constexpr uint8_t kNeverSolved = 255;

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
  std::vector<uint8_t> misses_;          ///< since the row was solved for
  std::vector<float> weights_;
};

/// Misses that a row is re-solved for after component k: few at first, while it knows little.
constexpr uint32_t misses_to_solve(uint32_t k) {
  if (k < 32) return 1;
  return k < 96 ? 2 : 4;
}

}  // namespace reeb
