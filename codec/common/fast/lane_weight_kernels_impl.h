// Bodies of the kernels that find the weights of lane fields; see codec/common/kernels_impl.h.
#pragma once

#include "codec/common/base/packed_matrix.h"
#include "codec/common/fast/lane_weight_kernels.h"
#include "codec/common/prediction/point_noise_impl.h"
#include "codec/common/prediction/row_vectors_impl.h"
#include "codec/common/simd/instruction_set.h"
#include "codec/common/simd/vectors_impl.h"

namespace reeb {

namespace {

/// A value of each of as many rows as are solved for together.
using RowFloats = float __attribute__((vector_size((kFloats < 8 ? 8 : kFloats) * sizeof(float))));
constexpr uint32_t kSolvedRows = kCount<RowFloats>;
using RowChunk = Chunk<RowFloats>;

/// y[i][k]: by how much neighbour i's observations first + k, k < 8, exceed the row's own.
inline void collect_differences(const Rows<RowFloats>& rows, const float* values, uint32_t stride,
                                RowFloats (*y)[8]) {
  RowChunk own[kSolvedRows];
  for (uint32_t l = 0; l < kSolvedRows; ++l)
    own[l] = load<RowChunk>(values + size_t{rows.index[l]} * stride);
  for (uint32_t i = 0; i < rows.count; ++i) {
    const auto from = [&](uint32_t l) {
      return load<RowChunk>(values + size_t{elements(rows.row[l]->neighbour)[i]} * stride) - own[l];
    };
    gather<RowFloats>(from, y[i]);
  }
}

template <uint32_t n>
inline RowFloats dot(const RowFloats* a, const RowFloats* b) {
  RowFloats out = a[0] * b[0];
  for (uint32_t k = 1; k < n; ++k) out += a[k] * b[k];
  return out;
}

/// The reference counts for as much as it is exact.
inline void learn_points(const LaneWeightTask& task, const Rows<RowFloats>& rows, RowFloats* a) {
  constexpr float kBending = 0x1p-11f;
  RowFloats y[kMaxNeighbours][8];
  collect_differences(rows, task.points, kPointStride, y);
  RowFloats spread{};
  for (uint32_t i = 0; i < rows.count; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] = dot<3>(y[i], y[j]);
    spread += a[packed(i, i)];
  }
  const RowFloats one = RowFloats{} + 1.0f;
  const RowFloats counts = rows.counts > one ? rows.counts : one;
  const RowFloats share = one / point_noise(spread / counts, kBending);
  for (uint32_t i = 0; i < packed(rows.count, 0); ++i) a[i] *= share;
}

/// How much a squared difference of one quantization step counts. In a wary field it counts the
/// less, the worse the row was predicted.
inline RowFloats value_share(const LaneWeightTask& task, const Rows<RowFloats>& rows) {
  constexpr float kNoise = 8.0f;
  constexpr float kWariness = 2.0f;
  RowFloats missed{};
  for (uint32_t l = 0; l < kSolvedRows && task.history != nullptr; ++l)
    missed[l] = static_cast<float>(task.history[rows.index[l]]) * 0.0625f;
  return (RowFloats{} + 1.0f) / (kNoise + kWariness * (missed * missed));
}

/// From eight components.
inline void learn_values(const Rows<RowFloats>& rows, const float* values, uint32_t stride,
                         const RowFloats& share, RowFloats* a) {
  RowFloats y[kMaxNeighbours][8];
  collect_differences(rows, values, stride, y);
  for (uint32_t i = 0; i < rows.count; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] += share * dot<8>(y[i], y[j]);
  }
}

inline void learn_together(const LaneWeightTask& task, const uint32_t* indices, float* const* out) {
  constexpr float kRing = 0.25f;
  constexpr float kBeyond = 0.625f;
  const auto rows = rows_of<RowFloats>(task.rows, indices);
  const uint32_t n = rows.count;
  RowFloats a[kSystem];
  learn_points(task, rows, a);
  const RowFloats share = value_share(task, rows);
  if (task.first_values != nullptr) learn_values(rows, task.first_values, kFirstLanes, share, a);
  if (task.values != nullptr) learn_values(rows, task.values, kRansLanes, share, a);
  if (task.first_values != nullptr) learn_values(rows, task.values + 8, kRansLanes, share, a);
  expect(rows, kRing, kBeyond, a);
  solve_system<2>(n, a);
  constrain(n, a + packed(n, 0), a + packed(n + 1, 0));
  store_weights(a + packed(n, 0), n, out);
}

void learn_lanes(const LaneWeightTask& task, const uint32_t* rows, float* const* out) {
  for (uint32_t first = 0; first < kWeightRows; first += kSolvedRows)
    learn_together(task, rows + first, out + first);
}

}  // namespace

template <>
const LaneWeightKernels& compiled_kernels<LaneWeightKernels, kCompiledFor>() {
  static constexpr LaneWeightKernels kKernels = {.learn = learn_lanes};
  return kKernels;
}

}  // namespace reeb
