// Arithmetic of the displacement predictor (lossless profile), eight rows at a time. Every lane is
// one row and keeps its own order of operations, so that any vector width gives the same bits.
#pragma once

#include <cstdint>

#include "codec/common/simd/kernels.h"

namespace reeb {

/// A row's displacement is predicted from `kOwnTerms` earlier ones of its own, which come first,
/// and from those of neighbours: kMaxNeighbours terms in all.
inline constexpr uint32_t kOwnTerms = 2;

/// Normal equations of eight rows.
struct alignas(64) DisplacementBatch {
  Lanes matrix[kTriangle];       ///< decaying sum of y y^T
  Lanes target[kMaxNeighbours];  ///< decaying sum of y d
  Lanes prior[kMaxNeighbours];   ///< weights expected before anything is learned
  Lanes in_use[kMaxNeighbours];  ///< 1 where there is a term, 0 for padding
  Lanes energy;                  ///< decaying mean squared error of the prediction
  uint32_t neighbour[kMaxNeighbours][kLanes];
  uint32_t self[kLanes];
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

using LearnDisplacementKernel = void (*)(DisplacementBatch&, const DisplacementFrame&);
/// Solves and writes the weights of lane l to out[l].
using SolveDisplacementKernel = void (*)(const DisplacementBatch&, float* const out[kLanes]);

struct DisplacementKernels {
  LearnDisplacementKernel learn;
  SolveDisplacementKernel solve;
};

/// The quickest kernels this processor has.
DisplacementKernels fastest_displacement_kernels();

}  // namespace reeb
