// Small symmetric systems of equations, one in every element of a vector; see
// codec/common/kernels_impl.h.
#pragma once

#include <cstdint>

#include "codec/common/base/packed_matrix.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/simd/vectors_impl.h"

namespace reeb {

namespace {

/// Entries of a matrix with two right sides: row i stands at packed(i, 0), up to the diagonal; the
/// right sides follow as if they were further rows.
constexpr uint32_t kSystem = packed(kMaxNeighbours + 2, 0);

/// Entry j of the rows `first` and on: of L, and of what is left of the right sides.
template <uint32_t kRows, class V>
inline void eliminate(V* a, uint32_t first, uint32_t j, const V* scaled, const V& inverse) {
  V* row[kRows];
  V left[kRows];
  for (uint32_t r = 0; r < kRows; ++r) {
    row[r] = a + packed(first + r, 0);
    left[r] = row[r][j];
  }
  for (uint32_t k = 0; k < j; ++k) {
    for (uint32_t r = 0; r < kRows; ++r) left[r] -= row[r][k] * scaled[k];
  }
  for (uint32_t r = 0; r < kRows; ++r) row[r][j] = left[r] * inverse;
}

/// A = L D L^T: leaves L below the diagonal, and D^-1 L^-1 b in place of a right side b. Where
/// rounding has eaten a pivot its 1/D is 0, which takes the unknown out of the system.
template <uint32_t kSides, class V>
inline void factorise(uint32_t n, V* a) {
  constexpr auto kMinPivot = static_cast<Element<V>>(sizeof(Element<V>) == 8 ? 0x1p-42 : 0x1p-20);
  constexpr uint32_t kTogetherRows = 4;
  const V zero{};
  const V one = zero + 1;
  V scaled[kMaxNeighbours];
  V diagonal[kMaxNeighbours];
  for (uint32_t j = 0; j < n; ++j) {
    const V* own = a + packed(j, 0);
    V d = own[j];
    const V floor = d * kMinPivot;
    for (uint32_t k = 0; k < j; ++k) {
      scaled[k] = own[k] * diagonal[k];
      d -= own[k] * scaled[k];
    }
    diagonal[j] = d > floor ? d : zero;
    const V inverse = d > floor ? one / (d > floor ? d : one) : zero;
    uint32_t i = j + 1;
    for (; i + kTogetherRows <= n + kSides; i += kTogetherRows)
      eliminate<kTogetherRows>(a, i, j, scaled, inverse);
    for (; i < n + kSides; ++i) eliminate<1>(a, i, j, scaled, inverse);
  }
}

/// Solves L^T x = x in place for the right sides, which stand at x, x + n + 1.
template <uint32_t kSides, class V>
inline void substitute_back(uint32_t n, const V* a, V* x) {
  for (uint32_t k = n; k-- > 1;) {
    const V* row = a + packed(k, 0);
    V known[kSides];
    for (uint32_t s = 0; s < kSides; ++s) known[s] = x[s * (n + 1) + k];
    for (uint32_t i = 0; i < k; ++i) {
      for (uint32_t s = 0; s < kSides; ++s) x[s * (n + 1) + i] -= row[i] * known[s];
    }
  }
}

/// Solves A x = b for each right side b, which x takes the place of: kSystem entries, of which n
/// unknowns and kSides right sides are in use. `V`: a vector of
/// binary64 or binary32.
template <uint32_t kSides, class V>
inline void solve_system(uint32_t n, V* a) {
  factorise<kSides>(n, a);
  substitute_back<kSides>(n, a, a + packed(n, 0));
}

/// w += b (1 - sum w) / sum b: the multiplier of the constraint that the weights sum to one, b
/// being the solution for ones.
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

}  // namespace

}  // namespace reeb
