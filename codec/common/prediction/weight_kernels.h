// The arithmetic that takes the main profile's time: weights of prediction, eight rows at a time.
// Every row keeps its own order of operations (see codec/common/simd/instruction_set.h).
#pragma once

#include <array>
#include <cstdint>

#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

inline constexpr uint32_t kRowsAtOnce = 8;

/// The matrix of a row's normal equations, sum of y y^T / noise: entry (i, j), j <= i, of the
/// matrix is strip[i][j] for i < 8; for i >= 8, strip[i][j] left of column 8, strip[16][i - 8] on
/// the diagonal, strip[15 - i][16 - i + j - 8] between them, which fills the rows above.
struct alignas(64) RowEquations {
  double strip[kMaxNeighbours + 1][8];
};
/// Their right sides, which are 0 where weights sum to one.
using RowTarget = std::array<double, kMaxNeighbours>;

/// Where the neighbours of kRowsAtOnce rows lie from them in the reference, by axis: 0 for padding.
struct PointDifferences {
  double neighbour[kMaxNeighbours][3][kRowsAtOnce];
  double inverse_noise[kRowsAtOnce];
};

/// Components that rows may learn from together.
inline constexpr uint32_t kObservations = 16;

/// What a row is to learn from.
struct FoldTask {
  const float* const* planes;  ///< of each observation, a value for each row
  const double* scale;         ///< of each observation: its noise is 1 then
  const uint32_t* neighbour;
  uint32_t count;  ///< neighbours
  uint32_t row;
  uint32_t begin, end;  ///< the observations to learn from
};

/// What the weights of rows come from.
struct SolveTask {
  const PredictionGraph::Row* rows;
  const RowEquations* equations;
  const RowTarget* targets;  ///< null where weights sum to one
  double ring_precision;     ///< 1 / deviation^2 of a ring neighbour's weight
  double extra_precision;    ///< of any other neighbour's
};

struct WeightKernels {
  /// Leaves what the differences tell in the equations of the rows, which have n neighbours at
  /// most.
  void (*observe_points)(const PointDifferences&, uint32_t n, RowEquations* const* rows);
  /// Adds the observations, one after another. `target`: null where weights sum to one.
  void (*fold)(RowEquations&, double* target, const FoldTask&);
  /// Weights of kRowsAtOnce rows, kMaxNeighbours of the l-th to out[l], 0 for padding.
  void (*solve)(const SolveTask&, const uint32_t* rows, float* const* out);
};

}  // namespace reeb
