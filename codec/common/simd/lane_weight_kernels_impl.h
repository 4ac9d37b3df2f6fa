// Bodies of the kernels that find the weights of lane fields; see kernels_impl.h.
#pragma once

#include <cstring>

#include "codec/common/simd/kernels.h"
#include "codec/common/simd/lane_kernels_impl.h"
#include "codec/common/simd/weight_kernels_impl.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed within a file only

namespace reeb::REEB_KERNEL_NAMESPACE {

namespace {

constexpr uint32_t kEights = kTogether / 8;

inline LanesF join(const Floats8* eights) {
#if defined(__AVX512F__)
  return __builtin_shufflevector(eights[0], eights[1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                 14, 15);
#else
  return eights[0];
#endif
}

/// out[k], for k < 8: the k-th of the floats at from(lane), of every lane.
template <class From>
inline void gather_eight(From from, LanesF* out) {
  Floats8 in[8];
  Floats8 turned[kEights][8];
  for (uint32_t e = 0; e < kEights; ++e) {
    for (uint32_t l = 0; l < 8; ++l) in[l] = from(8 * e + l);
    transpose(in, turned[e]);
  }
  for (uint32_t k = 0; k < 8; ++k) {
    Floats8 eights[kEights];
    for (uint32_t e = 0; e < kEights; ++e) eights[e] = turned[e][k];
    out[k] = join(eights);
  }
}

/// The rows of the lanes.
struct LaneRows {
  const PredictionGraph::Row* row[kTogether];
  uint32_t index[kTogether];
  uint32_t count = 0;  ///< the most neighbours that one has
  LanesF counts;
  LanesI rings;
};

inline LaneRows rows_of(const LaneWeightTask& task, const uint32_t* rows) {
  LaneRows out;
  for (uint32_t l = 0; l < kTogether; ++l) {
    out.index[l] = rows[l];
    out.row[l] = task.rows + rows[l];
    out.count = out.row[l]->count > out.count ? out.row[l]->count : out.count;
    out.counts[l] = out.row[l]->count;
    out.rings[l] = out.row[l]->ring;
  }
  return out;
}

/// y[i][k]: by how much neighbour i's observations first + k, k < 8, exceed the row's own.
inline void collect_differences(const LaneRows& rows, const float* values, uint32_t stride,
                                LanesF (*y)[8]) {
  Floats8 own[kTogether];
  for (uint32_t l = 0; l < kTogether; ++l)
    own[l] = load<Floats8>(values + size_t{rows.index[l]} * stride);
  for (uint32_t i = 0; i < rows.count; ++i) {
    const auto from = [&](uint32_t l) {
      return load<Floats8>(values + size_t{elements(rows.row[l]->neighbour)[i]} * stride) - own[l];
    };
    gather_eight(from, y[i]);
  }
}

template <uint32_t kCount>
inline LanesF dot(const LanesF* a, const LanesF* b) {
  LanesF out = a[0] * b[0];
  for (uint32_t k = 1; k < kCount; ++k) out += a[k] * b[k];
  return out;
}

/// The reference counts for as much as it is exact: to half a grid unit, and to the surface's
/// bending, relative to the mean squared distance of the neighbours.
inline void learn_points(const LaneWeightTask& task, const LaneRows& rows, LanesF* a) {
  constexpr float kGridVariance = 0.25f;
  constexpr float kBending = 0x1p-11f;
  LanesF y[kMaxNeighbours][8];
  collect_differences(rows, task.points, kPointStride, y);
  LanesF spread{};
  for (uint32_t i = 0; i < rows.count; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] = dot<3>(y[i], y[j]);
    spread += a[packed(i, i)];
  }
  const LanesF one = LanesF{} + 1.0f;
  const LanesF counts = rows.counts > one ? rows.counts : one;
  const LanesF share = one / (kGridVariance + kBending * (spread / counts));
  for (uint32_t i = 0; i < packed(rows.count, 0); ++i) a[i] *= share;
}

/// How much a squared difference of one quantization step counts. In a wary field it counts the
/// less, the worse the row was predicted.
inline LanesF value_share(const LaneWeightTask& task, const LaneRows& rows) {
  constexpr float kNoise = 8.0f;
  constexpr float kWariness = 2.0f;
  LanesF missed{};
  for (uint32_t l = 0; l < kTogether && task.history != nullptr; ++l)
    missed[l] = static_cast<float>(task.history[rows.index[l]]) * 0.0625f;
  return (LanesF{} + 1.0f) / (kNoise + kWariness * (missed * missed));
}

/// From eight components.
inline void learn_values(const LaneRows& rows, const float* values, uint32_t stride,
                         const LanesF& share, LanesF* a) {
  LanesF y[kMaxNeighbours][8];
  collect_differences(rows, values, stride, y);
  for (uint32_t i = 0; i < rows.count; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] += share * dot<8>(y[i], y[j]);
  }
}

/// Adds what is expected of the weights to the matrix, and writes the right sides: w, and ones
/// where there is a neighbour.
inline void expect(const LaneRows& rows, LanesF* a) {
  constexpr float kRing = 0.25f;
  constexpr float kBeyond = 0.625f;
  LanesF prior[kMaxNeighbours];
  LanesF precision[kMaxNeighbours];
  for (uint32_t i = 0; i < rows.count; i += 8) {
    gather_eight([&](uint32_t l) { return load<Floats8>(elements(rows.row[l]->prior) + i); },
                 prior + i);
    gather_eight([&](uint32_t l) { return load<Floats8>(elements(rows.row[l]->precision) + i); },
                 precision + i);
  }
  LanesF* const w = a + packed(rows.count, 0);
  LanesF* const ones = a + packed(rows.count + 1, 0);
  const LanesF zero{};
  for (uint32_t i = 0; i < rows.count; ++i) {
    const LanesF scale = static_cast<int32_t>(i) < rows.rings ? zero + kRing : zero + kBeyond;
    const LanesF sure = precision[i] * scale;
    a[packed(i, i)] += sure;
    w[i] = prior[i] * sure;
    ones[i] = static_cast<float>(i) < rows.counts ? zero + 1.0f : zero;
  }
}

inline void store_weights(const LanesF* w, float* const* out) {
  for (uint32_t i = 0; i < kMaxNeighbours; i += 8) {
    for (uint32_t first = 0; first < kTogether; first += 8) {
      Floats8 in[8];
      Floats8 turned[8];
      for (uint32_t k = 0; k < 8; ++k) {
        for (uint32_t l = 0; l < 8; ++l) in[k][l] = w[i + k][first + l];
      }
      transpose(in, turned);
      for (uint32_t l = 0; l < 8; ++l)
        std::memcpy(out[first + l] + i, &turned[l], sizeof turned[l]);
    }
  }
}

inline void learn_together(const LaneWeightTask& task, const uint32_t* indices, float* const* out) {
  const LaneRows rows = rows_of(task, indices);
  const uint32_t n = rows.count;
  LanesF a[kSystem];
  learn_points(task, rows, a);
  const LanesF share = value_share(task, rows);
  if (task.first_values != nullptr) learn_values(rows, task.first_values, kFirstLanes, share, a);
  if (task.values != nullptr) learn_values(rows, task.values, kRansLanes, share, a);
  if (task.first_values != nullptr) learn_values(rows, task.values + 8, kRansLanes, share, a);
  expect(rows, a);
  solve_system<2>(n, a);
  constrain(n, a + packed(n, 0), a + packed(n + 1, 0));
  LanesF w[kMaxNeighbours] = {};
  for (uint32_t i = 0; i < n; ++i) w[i] = a[packed(n, i)];
  store_weights(w, out);
}

void learn_lanes(const LaneWeightTask& task, const uint32_t* rows, float* const* out) {
  for (uint32_t first = 0; first < kWeightRows; first += kTogether)
    learn_together(task, rows + first, out + first);
}

}  // namespace

}  // namespace reeb::REEB_KERNEL_NAMESPACE
