// Bodies of the kernels that estimate weights; see codec/common/kernels_impl.h.
#pragma once

#include <cstring>
#include <utility>

#include "codec/common/base/packed_matrix.h"
#include "codec/common/prediction/row_vectors_impl.h"
#include "codec/common/prediction/weight_kernels.h"
#include "codec/common/simd/instruction_set.h"

namespace reeb {

namespace {

/// Calls function(k, entry) for the entries `first` + k of a strip, k < kDoubles, that are of a
/// matrix of n rows.
template <class Function>
inline void for_each_entry(uint32_t strip, uint32_t first, uint32_t n, Function function) {
  for (uint32_t k = 0; k < kDoubles; ++k) {
    const uint32_t at = first + k;
    const bool upper = strip < 8 && at <= strip;
    const bool square = strip >= 8 && strip < 16;
    const uint32_t i = upper || square ? strip : strip < 8 ? 15 - strip : 8 + at;
    const uint32_t j = upper || square ? at : strip < 8 ? 7 - strip + at : 8 + at;
    if (i < n) function(k, packed(i, j));
  }
}

/// The last strip in use, and one more.
inline uint32_t strip_count(uint32_t n) { return n <= 8 ? 8 : kMaxNeighbours + 1; }

inline void load_equations(const RowEquations* equations, const uint32_t* rows, uint32_t n,
                           Doubles* matrix) {
  Doubles in[kDoubles];
  Doubles out[kDoubles];
  for (uint32_t strip = 0; strip < strip_count(n); ++strip) {
    for (uint32_t first = 0; first < 8; first += kDoubles) {
      for (uint32_t l = 0; l < kDoubles; ++l)
        in[l] = load<Doubles>(equations[rows[l]].strip[strip] + first);
      transpose(in, out);
      for_each_entry(strip, first, n, [&](uint32_t k, uint32_t entry) { matrix[entry] = out[k]; });
    }
  }
}

inline void store_equations(const Doubles* matrix, RowEquations* const* rows) {
  Doubles in[kDoubles] = {};
  Doubles out[kDoubles];
  for (uint32_t strip = 0; strip <= kMaxNeighbours; ++strip) {
    for (uint32_t first = 0; first < 8; first += kDoubles) {
      for_each_entry(strip, first, kMaxNeighbours,
                     [&](uint32_t k, uint32_t entry) { in[k] = matrix[entry]; });
      transpose(in, out);
      for (uint32_t l = 0; l < kDoubles; ++l) store(rows[l]->strip[strip] + first, out[l]);
    }
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

/// All ones where place first + l is below k, for each element l.
template <uint32_t k, uint32_t first, uint32_t... l>
inline auto mask_below(std::integer_sequence<uint32_t, l...>) {
  using Mask = int64_t __attribute__((vector_size(sizeof(Doubles))));
  return Mask{(first + l < k ? -1 : 0)...};
}

/// What strip k < 8 adds of an observation in its places `first` and on: up to place k row k of
/// y y^T, beyond it row 15 - k from column 8 on.
template <uint32_t k, uint32_t first>
inline Doubles corner(const double* y) {
  const auto upper = mask_below<k + 1, first>(std::make_integer_sequence<uint32_t, kDoubles>());
  const auto column = load<Doubles>(y + first);
  const auto beyond = load<Doubles>(y + first + 7 - k);
  return (upper ? Doubles{} + y[k] : Doubles{} + y[15 - k]) * (upper ? column : beyond);
}

/// Adds to places `first` and on of the first eight strips: all sums stay in registers.
template <uint32_t first, uint32_t... k>
inline void add_corners(RowEquations& row, const FoldTask& task, const Said& said,
                        std::integer_sequence<uint32_t, k...>) {
  Doubles sum[] = {load<Doubles>(row.strip[k] + first)...};
  for (uint32_t o = task.begin; o < task.end; ++o) ((sum[k] += corner<k, first>(said.y[o])), ...);
  (store(row.strip[k] + first, sum[k]), ...);
}

template <uint32_t first = 0>
inline void add_all_corners(RowEquations& row, const FoldTask& task, const Said& said) {
  if constexpr (first < 8) {
    add_corners<first>(row, task, said, std::make_integer_sequence<uint32_t, 8>());
    add_all_corners<first + kDoubles>(row, task, said);
  }
}

/// The same for the other strips: rows 8 to 15, columns 0 to 7, and the diagonal beyond.
inline void add_square(RowEquations& row, const FoldTask& task, const Said& said, uint32_t first) {
  Doubles sum[8];
  for (uint32_t k = 0; k < 8; ++k) sum[k] = load<Doubles>(row.strip[8 + k] + first);
  auto diagonal = load<Doubles>(row.strip[kMaxNeighbours] + first);
  for (uint32_t o = task.begin; o < task.end; ++o) {
    const double* y = said.y[o];
    const auto column = load<Doubles>(y + first);
    const auto beyond = load<Doubles>(y + 8 + first);
    for (uint32_t k = 0; k < 8; ++k) sum[k] += y[8 + k] * column;
    diagonal += beyond * beyond;
  }
  for (uint32_t k = 0; k < 8; ++k) store(row.strip[8 + k] + first, sum[k]);
  store(row.strip[kMaxNeighbours] + first, diagonal);
}

void fold(RowEquations& row, double* target, const FoldTask& task) {
  Said said;
  collect(task, target == nullptr, said);
  add_all_corners(row, task, said);
  for (uint32_t first = 0; first < 8 && task.count > 8; first += kDoubles)
    add_square(row, task, said, first);
  if (target == nullptr) return;
  for (uint32_t o = task.begin; o < task.end; ++o) {
    for (uint32_t i = 0; i < kMaxNeighbours; ++i)
      target[i] += said.y[o][i] * (said.self[o] * task.scale[o]);
  }
}

void observe_points(const PointDifferences& y, uint32_t n, RowEquations* const* rows) {
  for (uint32_t first = 0; first < kRowsAtOnce; first += kDoubles) {
    const auto of = [&](uint32_t i, uint32_t a) {
      return load<Doubles>(y.neighbour[i][a] + first);
    };
    const auto inverse_noise = load<Doubles>(y.inverse_noise + first);
    Doubles matrix[packed(kMaxNeighbours, 0)] = {};
    for (uint32_t i = 0; i < n; ++i) {
      for (uint32_t j = 0; j <= i; ++j) {
        const Doubles dot = of(i, 0) * of(j, 0) + of(i, 1) * of(j, 1) + of(i, 2) * of(j, 2);
        matrix[packed(i, j)] = dot * inverse_noise;
      }
    }
    store_equations(matrix, rows + first);
  }
}

inline void add_targets(const SolveTask& task, const Rows<Doubles>& rows, Doubles* w) {
  for (uint32_t l = 0; l < kDoubles; ++l) {
    const double* target = elements(task.targets[rows.index[l]]);
    for (uint32_t i = 0; i < rows.count; ++i) w[i][l] += target[i];
  }
}

inline void solve_register(const SolveTask& task, const uint32_t* indices, float* const* out) {
  const auto rows = rows_of<Doubles>(task.rows, indices);
  const uint32_t n = rows.count;
  Doubles a[kSystem];
  Doubles* const w = a + packed(n, 0);
  load_equations(task.equations, rows.index, n, a);
  expect(rows, task.ring_precision, task.extra_precision, a);
  if (task.targets == nullptr) {
    solve_system<2>(n, a);
    constrain(n, w, a + packed(n + 1, 0));
  } else {
    add_targets(task, rows, w);
    solve_system<1>(n, a);
  }
  store_weights(w, n, out);
}

void solve(const SolveTask& task, const uint32_t* rows, float* const* out) {
  for (uint32_t first = 0; first < kRowsAtOnce; first += kDoubles)
    solve_register(task, rows + first, out + first);
}

}  // namespace

template <>
const WeightKernels& compiled_kernels<WeightKernels, kCompiledFor>() {
  static constexpr WeightKernels kKernels = {
      .observe_points = observe_points, .fold = fold, .solve = solve};
  return kKernels;
}

}  // namespace reeb
