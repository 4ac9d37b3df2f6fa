// The arithmetic that takes the decoder's time: weight estimation, eight rows at a time, and the
// sum of components. Every lane is one row and keeps its own order of operations, so that any
// vector width gives the same bits.
#pragma once

#include <array>
#include <cstdint>

#include "codec/common/prediction/prediction_graph.h"
#include "entropy/rans.h"

namespace reeb {

inline constexpr uint32_t kLanes = 8;
inline constexpr uint32_t kTriangle = kMaxNeighbours * (kMaxNeighbours + 1) / 2;

/// Index of entry (i, j), j <= i, of a symmetric matrix stored by rows.
constexpr uint32_t packed(uint32_t i, uint32_t j) { return i * (i + 1) / 2 + j; }

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// The matrix of a row's normal equations, sum of y y^T / noise: entry (i, j), j <= i, of the
/// matrix is strip[i][j] for i < 8; for i >= 8, strip[i][j] left of column 8, strip[16][i - 8] on
/// the diagonal, strip[15 - i][16 - i + j - 8] between them, which fills the rows above.
struct alignas(64) RowEquations {
  double strip[kMaxNeighbours + 1][8];
};
/// Their right sides, which are 0 where weights sum to one.
using RowTarget = std::array<double, kMaxNeighbours>;

/// Where the neighbours of kLanes rows lie from them in the reference, by axis: 0 for padding.
struct PointDifferences {
  double neighbour[kMaxNeighbours][3][kLanes];
  double inverse_noise[kLanes];
};

/// Leaves what they tell in the equations of the rows, which have n neighbours at most.
using ObservePointsKernel = void (*)(const PointDifferences&, uint32_t n,
                                     RowEquations* const* rows);

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

/// Adds the observations, one after another. `target`: null where weights sum to one.
using FoldKernel = void (*)(RowEquations&, double* target, const FoldTask&);

/// What the weights of rows come from.
struct SolveTask {
  const PredictionGraph::Row* rows;
  const RowEquations* equations;
  const RowTarget* targets;  ///< null where weights sum to one
  double ring_precision;     ///< 1 / deviation^2 of a ring neighbour's weight
  double extra_precision;    ///< of any other neighbour's
};

/// Weights of kLanes rows, kMaxNeighbours of the l-th to out[l], 0 for padding.
using SolveKernel = void (*)(const SolveTask&, const uint32_t* rows, float* const* out);

inline constexpr uint32_t kTileRows = 64;

/// The components of kTileRows vertices, all of which lie together, so that reading them is what
/// memory does best. Plain pointers: inline members of containers, compiled for one instruction
/// set, could be linked in for all.
struct ComponentTile {
  const float* wide;  ///< [component][vertex]
  uint32_t wide_count;
  const uint32_t* narrow;  ///< [pair][vertex]: two components, 16 bits each, signed
  uint32_t pair_count;
};

/// What the components count in one frame.
struct FrameBasis {
  const float* wide;       ///< [axis][component]
  const uint32_t* narrow;  ///< [axis][pair]
  float unit;              ///< of the narrow components' sum
  const double* mean;      ///< of each axis
};

/// Writes the positions of a tile's vertices, xyz after xyz. For each axis: sum = 0 + wide[0] *
/// tile.wide[0] + wide[1] * tile.wide[1] + ... in binary32, in this order; sum + unit * float(the
/// sum of the narrow products, which is within 32 bits); mean + sum in binary64, rounded.
using CombineKernel = void (*)(const ComponentTile& tile, const FrameBasis& basis, float* xyz);

/// What the kernels see of a LaneField: a block of components of all rows.
struct LaneBlock {
  const PredictionGraph::Row* rows = nullptr;
  const float* weights = nullptr;     ///< kMaxNeighbours a row
  const float* steps = nullptr;       ///< of each row
  const uint32_t* history = nullptr;  ///< of each row, in 1/16; null in the first block
  float* values = nullptr;            ///< [row][lane]
  uint16_t* magnitudes = nullptr;     ///< [row][lane]
  uint32_t running[kRansLanes] = {};  ///< decaying means of the magnitudes, in 1/256
  uint32_t before[kRansLanes] = {};   ///< the same without the last row
  uint32_t row_count = 0;
};

/// Prediction and context class of a row's components.
struct LaneGuess {
  float prediction[kRansLanes];
  uint32_t cls[kRansLanes];
};

/// What the weights of a lane field's rows come from: the reference, and the values of blocks that
/// are decoded, [row][lane].
struct LaneWeightTask {
  const PredictionGraph::Row* rows = nullptr;
  const float* points = nullptr;        ///< [row][kPointStride]: x, y, z of the reference
  const float* values = nullptr;        ///< of the last block; null where there is none
  const uint32_t* history = nullptr;    ///< of wary fields, of each row: see LaneBlock
  const float* first_values = nullptr;  ///< of the first one, kFirstLanes a row; null where that is
                                        ///< the last
};
/// Of the first block.
inline constexpr uint32_t kFirstLanes = kRansLanes / 2;
inline constexpr uint32_t kPointStride = 4;
inline constexpr uint32_t kWeightRows = 16;

/// Weights of kWeightRows rows, the l-th's to out[l], as spec/fast.md, section 4, has it.
using LearnLanesKernel = void (*)(const LaneWeightTask&, const uint32_t* rows, float* const* out);

using GuessLanesKernel = LaneGuess (*)(const LaneBlock&, uint32_t row);
using NoteLanesKernel = void (*)(LaneBlock&, uint32_t row, const LaneGuess&, const int32_t* n);
using DecodeLanesKernel = void (*)(LaneBlock&, RansDecoder&, uint32_t lanes);

struct Kernels {
  ObservePointsKernel observe_points;
  FoldKernel fold;
  SolveKernel solve;
  CombineKernel combine;
  GuessLanesKernel guess_lanes;
  NoteLanesKernel note_lanes;
  DecodeLanesKernel decode_lanes;
  LearnLanesKernel learn_lanes;
};

/// The quickest kernels this processor has.
Kernels fastest_kernels();

}  // namespace reeb
