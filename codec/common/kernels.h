// The arithmetic that takes the decoder's time: weight estimation, eight rows at a time, and the
// sum of components. Every lane is one row and keeps its own order of operations, so that any
// vector width gives the same bits.
#pragma once

#include <cstdint>

#include "codec/common/prediction_graph.h"

namespace reeb {

inline constexpr uint32_t kLanes = 8;
inline constexpr uint32_t kTriangle = kMaxNeighbours * (kMaxNeighbours + 1) / 2;

/// Index of entry (i, j), j <= i, of a symmetric matrix stored by rows.
constexpr uint32_t packed(uint32_t i, uint32_t j) { return i * (i + 1) / 2 + j; }

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// Normal equations of eight rows.
struct alignas(64) WeightBatch {
  Lanes matrix[kTriangle];          ///< sum of y y^T / noise
  Lanes target[kMaxNeighbours];     ///< sum of y t / noise
  Lanes prior[kMaxNeighbours];      ///< prior weight
  Lanes precision[kMaxNeighbours];  ///< 1 / deviation^2
  Lanes in_use[kMaxNeighbours];     ///< 1 where there is a neighbour, 0 for padding
  uint32_t neighbour[kMaxNeighbours][kLanes];
  uint32_t self[kLanes];
  uint32_t count = 0;  ///< largest number of neighbours among the eight
};

/// Adds one observation of every row: the plane of values, weighted by `inverse_noise`.
using AccumulateKernel = void (*)(WeightBatch&, const float* values, double inverse_noise,
                                  bool sum_to_one);

/// Solves and writes the weights of lane l to out[l].
using SolveKernel = void (*)(const WeightBatch&, bool sum_to_one, float* const out[kLanes]);

inline constexpr uint32_t kTileRows = 32;

/// Positions of kTileRows rows in one frame. For each axis a: sum[i] = (0 + scale[a][0] *
/// tile[0][i]) + scale[a][1] * tile[1][i] + ..., scale[a][k] being scale[a * plane_count + k], then
/// out[a][i] = sum[i] + mean[a] in binary64, rounded. `tile` is [plane][row]: all of a tile lies
/// together, so that reading it is what memory does best. Plain pointers: inline members of
/// containers, compiled for one instruction set, could be linked in for all.
using CombineKernel = void (*)(const float* tile, uint32_t plane_count, const float* scale,
                               const double mean[3], float (*out)[kTileRows]);

struct Kernels {
  AccumulateKernel accumulate;
  SolveKernel solve;
  CombineKernel combine;
};

/// The quickest kernels this processor has.
Kernels fastest_kernels();

}  // namespace reeb
