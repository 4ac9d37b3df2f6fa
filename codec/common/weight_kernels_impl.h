// Bodies of the kernels that estimate weights; see kernels_impl.h.
#pragma once

#include <cstring>
#include <utility>

#include "codec/common/kernels.h"
#include "codec/common/lane_solver_impl.h"
#include "codec/common/vector_load.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed within a file only

namespace reeb::REEB_KERNEL_NAMESPACE {

namespace {

#if defined(__AVX512F__)
constexpr uint32_t kFloats = 16;
#elif defined(__AVX__)
constexpr uint32_t kFloats = 8;
#else
constexpr uint32_t kFloats = 4;
#endif
/// A vector register of floats.
using Floats = float __attribute__((vector_size(kFloats * sizeof(float))));

/// Eight floats, however many registers that takes.
using Floats8 = float __attribute__((vector_size(8 * sizeof(float))));

/// out[i][l] = in[l][i].
template <class Vector>
inline void transpose(const Vector* in, Vector* out) {
  Vector a[8];
  Vector b[8];
  for (uint32_t i = 0; i < 4; ++i) {
    a[2 * i] = __builtin_shufflevector(in[i], in[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
    a[2 * i + 1] = __builtin_shufflevector(in[i], in[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
  }
  // a[2 i + h] holds elements 4 h .. 4 h + 3 of the vectors i and i + 4, by turns.
  for (uint32_t h = 0; h < 2; ++h) {
    for (uint32_t i = 0; i < 2; ++i) {
      const Vector x = a[2 * i + h];
      const Vector y = a[2 * i + 4 + h];
      b[4 * h + 2 * i] = __builtin_shufflevector(x, y, 0, 8, 1, 9, 2, 10, 3, 11);
      b[4 * h + 2 * i + 1] = __builtin_shufflevector(x, y, 4, 12, 5, 13, 6, 14, 7, 15);
    }
  }
  // b[4 h + 2 i + g] holds elements 4 h + 2 g, + 1 of the vectors i, i + 2, i + 4, i + 6, by turns.
  for (uint32_t h = 0; h < 2; ++h) {
    for (uint32_t g = 0; g < 2; ++g) {
      const Vector x = b[4 * h + g];
      const Vector y = b[4 * h + 2 + g];
      out[4 * h + 2 * g] = __builtin_shufflevector(x, y, 0, 8, 1, 9, 2, 10, 3, 11);
      out[4 * h + 2 * g + 1] = __builtin_shufflevector(x, y, 4, 12, 5, 13, 6, 14, 7, 15);
    }
  }
}

/// Calls function(k, entry) for the lanes k of a strip whose entries are of a matrix of n rows.
template <class Function>
inline void for_each_entry(uint32_t strip, uint32_t n, Function function) {
  for (uint32_t k = 0; k < 8; ++k) {
    const bool upper = strip < 8 && k <= strip;
    const uint32_t i = upper || (strip >= 8 && strip < 16) ? strip : strip < 8 ? 15 - strip : 8 + k;
    const uint32_t j = upper || (strip >= 8 && strip < 16) ? k : strip < 8 ? 7 - strip + k : 8 + k;
    if (i < n) function(k, packed(i, j));
  }
}

/// The last strip in use, and one more.
inline uint32_t strip_count(uint32_t n) { return n <= 8 ? 8 : kMaxNeighbours + 1; }

inline void load_equations(const RowEquations* equations, const uint32_t* rows, uint32_t n,
                           Lanes* matrix) {
  Lanes in[8];
  Lanes out[8];
  for (uint32_t strip = 0; strip < strip_count(n); ++strip) {
    for (uint32_t l = 0; l < kLanes; ++l) in[l] = equations[rows[l]].strip[strip];
    transpose(in, out);
    for_each_entry(strip, n, [&](uint32_t k, uint32_t entry) { matrix[entry] = out[k]; });
  }
}

inline void store_equations(const Lanes* matrix, RowEquations* const rows[kLanes]) {
  Lanes in[8];
  Lanes out[8];
  for (uint32_t strip = 0; strip <= kMaxNeighbours; ++strip) {
    for_each_entry(strip, kMaxNeighbours,
                   [&](uint32_t k, uint32_t entry) { in[k] = matrix[entry]; });
    transpose(in, out);
    for (uint32_t l = 0; l < kLanes; ++l) rows[l]->strip[strip] = out[l];
  }
}

/// What the neighbours of a row say of it, scaled y[observation][neighbour], and its own values.
struct Said {
  alignas(64) double y[kObservations][kMaxNeighbours];
  double self[kObservations];
};

inline void collect(const FoldTask& task, bool to_one, Said& said) {
  for (uint32_t o = task.begin; o < task.end; ++o) {
    const float* plane = task.planes[o];
    float value[kMaxNeighbours] = {};
    for (uint32_t i = 0; i < task.count; ++i) value[i] = plane[task.neighbour[i]];
    const double self = static_cast<double>(plane[task.row]);
    said.self[o] = self;
    for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
      const double v = static_cast<double>(value[i]);
      said.y[o][i] = i < task.count ? (to_one ? v - self : v) * task.scale[o] : 0;
    }
  }
}

constexpr uint32_t kRows = kFloats / 2;  // all sums stay in registers

/// y[0], ..., y[k], then y[8], y[9], ...
template <uint32_t k, uint32_t... l>
inline Lanes columns_of_corner(Lanes low, Lanes high, std::integer_sequence<uint32_t, l...>) {
  return __builtin_shufflevector(low, high, (l <= k ? l : 7 - k + l)...);
}

/// What strip k adds of one observation: the first k + 1 lanes are of row k, the others of row
/// 15 - k.
template <uint32_t k>
inline Lanes corner(const double* y, Lanes low, Lanes high) {
  using Mask = int64_t __attribute__((vector_size(sizeof(Lanes))));
  constexpr Mask kOfRow = {-1,
                           k > 0 ? -1 : 0,
                           k > 1 ? -1 : 0,
                           k > 2 ? -1 : 0,
                           k > 3 ? -1 : 0,
                           k > 4 ? -1 : 0,
                           k > 5 ? -1 : 0,
                           k > 6 ? -1 : 0};
  const Lanes row = kOfRow ? Lanes{} + y[k] : Lanes{} + y[15 - k];
  return row * columns_of_corner<k>(low, high, std::make_integer_sequence<uint32_t, 8>());
}

/// Adds to the strips `first` and on, of the first eight.
template <uint32_t first, uint32_t... k>
inline void add_corners(Lanes* strip, const FoldTask& task, const Said& said,
                        std::integer_sequence<uint32_t, k...>) {
  Lanes sum[] = {strip[first + k]...};
  for (uint32_t o = task.begin; o < task.end; ++o) {
    const double* y = said.y[o];
    const auto low = load<Lanes>(y);
    const auto high = load<Lanes>(y + 8);
    ((sum[k] += corner<first + k>(y, low, high)), ...);
  }
  ((strip[first + k] = sum[k]), ...);
}

template <uint32_t first = 0>
inline void add_all_corners(Lanes* strip, const FoldTask& task, const Said& said) {
  if constexpr (first < 8) {
    add_corners<first>(strip, task, said, std::make_integer_sequence<uint32_t, kRows>());
    add_all_corners<first + kRows>(strip, task, said);
  }
}

/// Adds to kRows strips of the next eight: rows i and on, columns 0 .. 7.
inline void add_square(Lanes* strip, const FoldTask& task, const Said& said, uint32_t i) {
  Lanes sum[kRows];
  for (uint32_t k = 0; k < kRows; ++k) sum[k] = strip[i + k];
  for (uint32_t o = task.begin; o < task.end; ++o) {
    const auto y = load<Lanes>(said.y[o]);
    for (uint32_t k = 0; k < kRows; ++k) sum[k] += said.y[o][i + k] * y;
  }
  for (uint32_t k = 0; k < kRows; ++k) strip[i + k] = sum[k];
}

/// Adds to the last strip.
inline void add_diagonal(Lanes* strip, const FoldTask& task, const Said& said) {
  for (uint32_t o = task.begin; o < task.end; ++o) {
    const auto y = load<Lanes>(said.y[o] + 8);
    strip[kMaxNeighbours] += y * y;
  }
}

void fold(RowEquations& row, double* target, const FoldTask& task) {
  Said said;
  collect(task, target == nullptr, said);
  add_all_corners(row.strip, task, said);
  if (task.count > 8) {
    for (uint32_t i = 8; i < kMaxNeighbours; i += kRows) add_square(row.strip, task, said, i);
    add_diagonal(row.strip, task, said);
  }
  if (target == nullptr) return;
  for (uint32_t o = task.begin; o < task.end; ++o) {
    for (uint32_t i = 0; i < kMaxNeighbours; ++i)
      target[i] += said.y[o][i] * (said.self[o] * task.scale[o]);
  }
}

void observe_points(const Lanes (*y)[3], const Lanes& inverse_noise, uint32_t n,
                    RowEquations* const rows[kLanes]) {
  Lanes matrix[kTriangle] = {};
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j <= i; ++j) {
      const Lanes dot = y[i][0] * y[j][0] + y[i][1] * y[j][1] + y[i][2] * y[j][2];
      matrix[packed(i, j)] = dot * inverse_noise;
    }
  }
  store_equations(matrix, rows);
}

/// The rows of the lanes.
struct SolveRows {
  const PredictionGraph::Row* row[kLanes];
  uint32_t index[kLanes];
  uint32_t count = 0;  ///< the most neighbours that one has
  Lanes counts;
  Lanes rings;
};

inline SolveRows rows_of(const SolveTask& task, const uint32_t* rows) {
  SolveRows out;
  for (uint32_t l = 0; l < kLanes; ++l) {
    out.index[l] = rows[l];
    out.row[l] = task.rows + rows[l];
    out.count = out.row[l]->count > out.count ? out.row[l]->count : out.count;
    out.counts[l] = out.row[l]->count;
    out.rings[l] = out.row[l]->ring;
  }
  return out;
}

/// out[k], for k < 8: the k-th of the floats at from(lane), of every lane.
template <class From>
inline void gather_lanes(From from, Lanes* out) {
  Floats8 in[8];
  Floats8 turned[8];
  for (uint32_t l = 0; l < kLanes; ++l) in[l] = load<Floats8>(from(l));
  transpose(in, turned);
  for (uint32_t k = 0; k < 8; ++k) out[k] = __builtin_convertvector(turned[k], Lanes);
}

/// Adds what is expected of the weights to the matrix, and writes the right sides: w, and ones
/// where there is a neighbour.
inline void expect(const SolveTask& task, const SolveRows& rows, Lanes* a) {
  const uint32_t n = rows.count;
  Lanes* const w = a + packed(n, 0);
  Lanes* const ones = a + packed(n + 1, 0);
  const Lanes zero{};
  for (uint32_t first = 0; first < n; first += 8) {
    Lanes prior[8];
    Lanes precision[8];
    gather_lanes([&](uint32_t l) { return elements(rows.row[l]->prior) + first; }, prior);
    gather_lanes([&](uint32_t l) { return elements(rows.row[l]->precision) + first; }, precision);
    for (uint32_t k = 0; k < 8 && first + k < n; ++k) {
      const uint32_t i = first + k;
      const Lanes place = zero + static_cast<double>(i);
      const Lanes sure = precision[k] * (place < rows.rings ? zero + task.ring_precision
                                                            : zero + task.extra_precision);
      a[packed(i, i)] += sure;
      w[i] = prior[k] * sure;
      ones[i] = place < rows.counts ? zero + 1 : zero;
    }
  }
}

inline void add_targets(const SolveTask& task, const SolveRows& rows, Lanes* w) {
  for (uint32_t l = 0; l < kLanes; ++l) {
    const double* target = elements(task.targets[rows.index[l]]);
    for (uint32_t i = 0; i < rows.count; ++i) w[i][l] += target[i];
  }
}

inline void store_weights(const Lanes* w, float* const* out) {
  for (uint32_t i = 0; i < kMaxNeighbours; i += 8) {
    Floats8 in[8];
    Floats8 turned[8];
    for (uint32_t k = 0; k < 8; ++k) in[k] = __builtin_convertvector(w[i + k], Floats8);
    transpose(in, turned);
    for (uint32_t l = 0; l < kLanes; ++l) std::memcpy(out[l] + i, &turned[l], sizeof turned[l]);
  }
}

void solve(const SolveTask& task, const uint32_t* indices, float* const* out) {
  const SolveRows rows = rows_of(task, indices);
  const bool to_one = task.targets == nullptr;
  const uint32_t n = rows.count;
  Lanes a[kSystem];
  load_equations(task.equations, rows.index, n, a);
  expect(task, rows, a);
  if (to_one) {
    solve_system<2>(n, a);
    constrain(n, a + packed(n, 0), a + packed(n + 1, 0));
  } else {
    add_targets(task, rows, a + packed(n, 0));
    solve_system<1>(n, a);
  }
  Lanes w[kMaxNeighbours] = {};
  for (uint32_t i = 0; i < n; ++i) w[i] = a[packed(n, i)];
  store_weights(w, out);
}

}  // namespace

}  // namespace reeb::REEB_KERNEL_NAMESPACE
