// Prediction weights that learn while decoding: for every row of a field, ridge least squares over
// what is decoded so far (the reference positions and earlier components), re-solved where
// predictions failed.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec/common/base/batches.h"
#include "codec/common/base/stop.h"
#include "codec/common/mesh/grid.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/prediction/weight_kernels.h"
#include "codec/common/simd/instruction_set.h"

namespace reeb {

struct WeightOptions {
  double ring_deviation = 1.4;   ///< prior standard deviation of a ring neighbour's weight
  double extra_deviation = 0.9;  ///< of any other neighbour's
  bool sum_to_one = true;        ///< weights reproduce constants
};

/// Weights minimise sum_o (sum_i w_i y_oi - t_o)^2 / noise_o + sum_i (w_i - prior_i)^2 /
/// deviation_i^2. All of it in binary64, in the order that spec/prediction.md fixes, rounded once
/// to binary32.
///
/// A row that its weights have predicted without error keeps them: what it has observed since
/// agrees with them, so that they are the minimum still, and need not be learned from. A component
/// in which a row erred is a *miss* of its weights.
class WeightEstimator {
 public:
  /// `graph` must outlive the estimator. `threads` >= 1; the weights do not depend on it.
  WeightEstimator(const PredictionGraph& graph, const WeightOptions& options, unsigned threads);
  WeightEstimator(const WeightEstimator& other) = default;
  WeightEstimator& operator=(const WeightEstimator&) = delete;

  /// From now on, finding weights throws Stopped where it is requested.
  void set_stop(const StopToken& stop) { stop_ = stop; }

  /// Learns from the reference positions, taken as exact to half a grid unit and to the surface's
  /// bending, and solves for all rows. `order[row]` is the row's point. Pre-condition: nothing is
  /// observed yet.
  void observe_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// The same where no more than kObservations components will be learned from: nothing of that is
  /// kept, which is most of what an estimator takes, but found again whenever a row is solved for.
  /// The grid and `order` must outlive the estimator, and it must not fade.
  void borrow_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Decoded components, a value for each row; the last ones are those that are being learned from.
  using Planes = std::vector<std::vector<float>>;

  /// Starts a component to learn from. `planes`: without it.
  void begin_component(const Planes& planes);

  /// The row's value in the component being decoded is not what its weights predicted.
  void miss(uint32_t row) {
    if (misses_[row] < kNeverSolved) ++misses_[row];
  }

  /// Puts the component, whose residuals had the given variance, on the list of what rows learn
  /// from when they are solved for, or when it is full and they missed.
  void finish_component(double noise) { scale_[observations_++] = 1.0 / std::sqrt(noise); }

  /// Lets all that is observed count `factor` times as much; all rows count as never solved
  /// for. The next component to learn from begins new planes.
  void fade(double factor, const Planes& planes);

  /// Brings the weights of rows up to date that have had as many misses since they were last solved
  /// for, up to 254, or that never were.
  void solve(uint32_t misses, const Planes& planes);

  /// kMaxNeighbours weights of a row; 0 for padding.
  const float* weights(uint32_t row) const { return &weights_[size_t{row} * kMaxNeighbours]; }

 private:
  /// The planes that a list of observations stands for.
  using List = std::array<const float*, kObservations>;

  List list(const Planes& planes) const;
  void make_equations();
  /// From the reference alone; `prepare(eight)` is called before each eight rows.
  template <class Prepare>
  void solve_reference(Prepare prepare);
  /// Starts a new list of observations: rows that missed learn from the old one, the others agree
  /// with it.
  void end_list(const Planes& planes);
  void fold(uint32_t row, const List& list);
  /// Rows of so many misses or more, which are 0 then.
  std::vector<uint32_t> take_missed(uint32_t misses);
  /// For rows[first] and the seven after it.
  void solve_eight(const std::vector<uint32_t>& rows, uint32_t first, const List& list);
  SolveTask task(const PredictionGraph::Row* rows, const RowEquations* equations) const;
  /// The same from nothing but the reference and the list.
  void solve_anew(const uint32_t row[kRowsAtOnce], const List& list, float* const* out) const;

  /// Positions that are there to learn from again.
  struct Reference {
    GridPoints points;
    const std::vector<uint32_t>* order;
  };

  static constexpr uint8_t kNeverSolved = 255;

  const PredictionGraph& graph_;
  WeightOptions options_;
  unsigned threads_;
  StopToken stop_;
  WeightKernels kernels_ = fastest_kernels<WeightKernels>();
  BatchVector<RowEquations> equations_;  ///< none before something is learned
  std::vector<RowTarget> targets_;       ///< none where weights sum to one
  double scale_[kObservations] = {};     ///< 1 / sqrt(noise) of the observations of the list
  uint32_t observations_ = 0;            ///< on the list
  std::vector<uint8_t> folded_;          ///< of these, those in the row's equations
  std::vector<uint8_t> misses_;          ///< since the row was solved for
  std::vector<uint32_t> by_count_;  ///< rows: those solved for together have as many neighbours
  std::vector<float> weights_;
  std::optional<Reference> borrowed_;
};

/// Misses that a row is re-solved for after component k: few at first, while it knows little.
constexpr uint32_t misses_to_solve(uint32_t k) {
  if (k < 32) return 1;
  return k < 96 ? 2 : 4;
}

}  // namespace reeb
