// The arithmetic of the displacement predictor (lossless profile), eight rows at a time. Every row
// keeps its own order of operations (see codec/common/simd/instruction_set.h).
#pragma once

#include <cstdint>

#include "codec/common/base/packed_matrix.h"
#include "codec/common/prediction/weight_kernels.h"

namespace reeb {

/// A row's displacement is predicted from `kOwnTerms` earlier ones of its own, which come first,
/// and from those of neighbours: kMaxNeighbours terms in all.
inline constexpr uint32_t kOwnTerms = 2;

/// A value of each of eight rows.
using RowValues = double __attribute__((vector_size(kRowsAtOnce * sizeof(double))));

/// Normal equations of eight rows.
struct alignas(64) DisplacementBatch {
  RowValues matrix[packed(kMaxNeighbours, 0)];  ///< decaying sum of y y^T
  RowValues target[kMaxNeighbours];             ///< decaying sum of y d
  RowValues prior[kMaxNeighbours];              ///< weights expected before anything is learned
  RowValues in_use[kMaxNeighbours];             ///< 1 where there is a term, 0 for padding
  RowValues energy;                             ///< decaying mean squared error of the prediction
  uint32_t neighbour[kMaxNeighbours][kRowsAtOnce];
  uint32_t self[kRowsAtOnce];
  uint32_t count = 0;  ///< largest number of terms among the eight
};

/// What a frame has brought: displacements [row][x, y, z, unused] of this frame and the two before,
/// and the squared error of each row's prediction.
struct DisplacementFrame {
  const float* now;
  const float* before;
  const float* older;
  const double* squared_error;
};

struct DisplacementKernels {
  void (*learn)(DisplacementBatch&, const DisplacementFrame&);
  /// Solves and writes the weights of row l to out[l].
  void (*solve)(const DisplacementBatch&, float* const* out);
};

}  // namespace reeb
