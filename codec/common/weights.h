// Prediction weights that learn while decoding: for every row of a field, ridge least squares over
// everything decoded so far (the reference positions and all earlier components), re-solved on a
// thinning schedule.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "codec/common/grid.h"
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
class WeightEstimator {
 public:
  /// `graph` must outlive the estimator. `threads` >= 1; the weights do not depend on it.
  WeightEstimator(const PredictionGraph& graph, const WeightOptions& options, unsigned threads);
  ~WeightEstimator();
  /// Pre-condition of a copy: nothing is observed that is not solved for.
  WeightEstimator(const WeightEstimator& other);
  WeightEstimator& operator=(const WeightEstimator&) = delete;

  /// Learns from the reference positions, taken as exact to half a grid unit and to the surface's
  /// bending. `order[row]` is the row's point.
  void observe_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Learns from one decoded component (`values`, one per row), whose residuals had the given
  /// variance. The values must stay where they are until the next `solve`.
  void observe(const float* values, double noise);

  /// Brings the weights up to date with all observations, which from then on count `fading` times
  /// as much.
  void solve(double fading = 1);

  /// kMaxNeighbours weights of a row; 0 for padding.
  const float* weights(uint32_t row) const { return &weights_[size_t{row} * kMaxNeighbours]; }

 private:
  struct Batches;
  struct Observation {
    const float* values;
    double inverse_noise;
  };
  const PredictionGraph& graph_;
  WeightOptions options_;
  unsigned threads_;
  std::unique_ptr<Batches> batches_;
  std::vector<Observation> pending_;
  std::vector<float> weights_;
};

/// The weights that a WeightEstimator has after `observe_reference` and `solve`: kMaxNeighbours a
/// row.
std::vector<float> reference_weights(const PredictionGraph& graph, const WeightOptions& options,
                                     const GridPoints& points, const std::vector<uint32_t>& order);

/// True where the weights are re-solved after component k: every one at first, then ever fewer.
constexpr bool resolve_after(uint32_t k) {
  if (k < 4) return true;
  if (k < 16) return k % 2 == 1;
  if (k < 64) return k % 4 == 3;
  return k % 16 == 15;
}

}  // namespace reeb
