// Bodies of the kernels that estimate weights; see kernels_impl.h.
#pragma once

#include <cstring>
#include <type_traits>
#include <utility>

#include "codec/common/kernels.h"
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

void load_equations(WeightBatch& batch, const RowEquations* const rows[kLanes]) {
  Lanes in[8];
  Lanes out[8];
  for (uint32_t strip = 0; strip < strip_count(batch.count); ++strip) {
    for (uint32_t l = 0; l < kLanes; ++l) in[l] = rows[l]->strip[strip];
    transpose(in, out);
    for_each_entry(strip, batch.count,
                   [&](uint32_t k, uint32_t entry) { batch.matrix[entry] = out[k]; });
  }
}

void store_equations(const WeightBatch& batch, RowEquations* const rows[kLanes]) {
  Lanes in[8];
  Lanes out[8];
  for (uint32_t strip = 0; strip < strip_count(batch.count); ++strip) {
    for_each_entry(strip, kMaxNeighbours,
                   [&](uint32_t k, uint32_t entry) { in[k] = batch.matrix[entry]; });
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
  for (uint32_t o = task.begin / 8 * 8; o < task.end; o += 8) {
    // Mostly but a few of the eight are asked for.
    const uint32_t first = task.begin > o ? task.begin - o : 0;
    const uint32_t last = task.end < o + 8 ? task.end - o : 8;
    const Floats8 self = load<Floats8>(task.values + size_t{task.row} * kObservations + o);
    for (uint32_t k = first; k < last; ++k) said.self[o + k] = static_cast<double>(self[k]);
    const Floats8 padding = to_one ? self : Floats8{};
    for (uint32_t i = 0; i < kMaxNeighbours; i += 8) {
      Floats8 in[8];
      Floats8 out[8];
      for (uint32_t k = 0; k < 8; ++k) {
        const bool used = i + k < task.count;
        in[k] = used
                    ? load<Floats8>(task.values + size_t{task.neighbour[i + k]} * kObservations + o)
                    : padding;
      }
      transpose(in, out);
      for (uint32_t k = first; k < last; ++k) {
        const Lanes value = __builtin_convertvector(out[k], Lanes);
        const Lanes y = (to_one ? value - said.self[o + k] : value) * task.scale[o + k];
        std::memcpy(&said.y[o + k][i], &y, sizeof y);
      }
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

void observe_points(WeightBatch& batch, const Lanes (*y)[3], const Lanes& inverse_noise) {
  for (uint32_t i = 0; i < batch.count; ++i) {
    for (uint32_t j = 0; j <= i; ++j) {
      const Lanes dot = y[i][0] * y[j][0] + y[i][1] * y[j][1] + y[i][2] * y[j][2];
      batch.matrix[packed(i, j)] += dot * inverse_noise;
    }
  }
}

/// A = L D L^T in place: L below the diagonal, 1/D in `inverse`. Where rounding has eaten a pivot
/// its 1/D is 0, which takes the neighbour out of the system. `V`: rows, in binary64 or binary32.
template <class V>
inline void factorise(uint32_t n, V* a, V* inverse) {
  using Real = std::remove_reference_t<decltype(a[0][0])>;
  constexpr auto kLeastPivot = static_cast<Real>(sizeof(Real) == 8 ? 0x1p-42 : 0x1p-20);
  const V zero{};
  const V one = zero + 1;
  V scaled[kMaxNeighbours];
  V diagonal[kMaxNeighbours];
  for (uint32_t j = 0; j < n; ++j) {
    V d = a[packed(j, j)];
    const V floor = d * kLeastPivot;
    for (uint32_t k = 0; k < j; ++k) {
      scaled[k] = a[packed(j, k)] * diagonal[k];
      d -= a[packed(j, k)] * scaled[k];
    }
    diagonal[j] = d > floor ? d : zero;
    inverse[j] = d > floor ? one / (d > floor ? d : one) : zero;
    for (uint32_t i = j + 1; i < n; ++i) {
      V t = a[packed(i, j)];
      for (uint32_t k = 0; k < j; ++k) t -= a[packed(i, k)] * scaled[k];
      a[packed(i, j)] = t * inverse[j];
    }
  }
}

/// Solves L D L^T x = x in place.
template <class V>
inline void substitute(uint32_t n, const V* a, const V* inverse, V* x) {
  for (uint32_t i = 1; i < n; ++i) {
    for (uint32_t k = 0; k < i; ++k) x[i] -= a[packed(i, k)] * x[k];
  }
  for (uint32_t i = 0; i < n; ++i) x[i] *= inverse[i];
  for (uint32_t i = n; i-- > 0;) {
    for (uint32_t k = i + 1; k < n; ++k) x[i] -= a[packed(k, i)] * x[k];
  }
}

/// w += b (1 - sum w) / sum b: the multiplier of the constraint that the weights sum to one.
template <class V>
inline void constrain(uint32_t n, V* w, const V* b) {
  V sum_w{};
  V sum_b{};
  for (uint32_t i = 0; i < n; ++i) {
    sum_w += w[i];
    sum_b += b[i];
  }
  const V zero{};
  const V one = zero + 1;
  const V factor = sum_b > zero ? (one - sum_w) / (sum_b > zero ? sum_b : one) : zero;
  for (uint32_t i = 0; i < n; ++i) w[i] += b[i] * factor;
}

void solve(const WeightBatch& batch, bool sum_to_one, float* const out[kLanes]) {
  const uint32_t n = batch.count;
  Lanes a[kTriangle];
  Lanes inverse[kMaxNeighbours];
  Lanes w[kMaxNeighbours];
  Lanes b[kMaxNeighbours];
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] = batch.matrix[packed(i, j)];
    a[packed(i, i)] += batch.precision[i];
    w[i] = batch.prior[i] * batch.precision[i] + batch.target[i];
    b[i] = batch.in_use[i];
  }
  factorise(n, a, inverse);
  substitute(n, a, inverse, w);
  if (sum_to_one) {
    substitute(n, a, inverse, b);
    constrain(n, w, b);
  }
  for (uint32_t l = 0; l < kLanes; ++l) {
    for (uint32_t i = 0; i < n; ++i) out[l][i] = static_cast<float>(w[i][l]);
  }
}

}  // namespace

}  // namespace reeb::REEB_KERNEL_NAMESPACE
