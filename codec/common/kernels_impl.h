// Bodies of the kernels, compiled once per instruction set; REEB_KERNEL_NAMESPACE tells
// which. No function here may be shared between instruction sets, hence the namespace.
#pragma once

#include <cstring>

#include "codec/common/kernels.h"

namespace reeb::REEB_KERNEL_NAMESPACE {

namespace {

void accumulate(WeightBatch& batch, const float* values, double inverse_noise, bool sum_to_one) {
  const uint32_t n = batch.count;
  Lanes self{};
  for (uint32_t l = 0; l < kLanes; ++l) self[l] = static_cast<double>(values[batch.self[l]]);
  Lanes y[kMaxNeighbours];
  for (uint32_t i = 0; i < n; ++i) {
    Lanes value{};
    for (uint32_t l = 0; l < kLanes; ++l)
      value[l] = static_cast<double>(values[batch.neighbour[i][l]]);
    y[i] = sum_to_one ? value - self : value * batch.in_use[i];
  }
  for (uint32_t i = 0; i < n; ++i) {
    const Lanes scaled = y[i] * inverse_noise;
    for (uint32_t j = 0; j <= i; ++j) batch.matrix[packed(i, j)] += scaled * y[j];
    if (!sum_to_one) batch.target[i] += scaled * self;
  }
}

/// A = L D L^T in place: L below the diagonal, 1/D in `inverse`. Where rounding has eaten a pivot
/// its 1/D is 0, which takes the neighbour out of the system.
inline void factorise(uint32_t n, Lanes* a, Lanes* inverse) {
  const Lanes zero{};
  const Lanes one = zero + 1.0;
  Lanes scaled[kMaxNeighbours];
  Lanes diagonal[kMaxNeighbours];
  for (uint32_t j = 0; j < n; ++j) {
    Lanes d = a[packed(j, j)];
    const Lanes floor = d * 0x1p-42;
    for (uint32_t k = 0; k < j; ++k) {
      scaled[k] = a[packed(j, k)] * diagonal[k];
      d -= a[packed(j, k)] * scaled[k];
    }
    diagonal[j] = d > floor ? d : zero;
    inverse[j] = d > floor ? 1.0 / (d > floor ? d : one) : zero;
    for (uint32_t i = j + 1; i < n; ++i) {
      Lanes t = a[packed(i, j)];
      for (uint32_t k = 0; k < j; ++k) t -= a[packed(i, k)] * scaled[k];
      a[packed(i, j)] = t * inverse[j];
    }
  }
}

/// Solves L D L^T x = x in place.
inline void substitute(uint32_t n, const Lanes* a, const Lanes* inverse, Lanes* x) {
  for (uint32_t i = 1; i < n; ++i) {
    for (uint32_t k = 0; k < i; ++k) x[i] -= a[packed(i, k)] * x[k];
  }
  for (uint32_t i = 0; i < n; ++i) x[i] *= inverse[i];
  for (uint32_t i = n; i-- > 0;) {
    for (uint32_t k = i + 1; k < n; ++k) x[i] -= a[packed(k, i)] * x[k];
  }
}

/// w += b (1 - sum w) / sum b: the multiplier of the constraint that the weights sum to one.
inline void constrain(uint32_t n, Lanes* w, const Lanes* b) {
  Lanes sum_w{};
  Lanes sum_b{};
  for (uint32_t i = 0; i < n; ++i) {
    sum_w += w[i];
    sum_b += b[i];
  }
  const Lanes zero{};
  const Lanes one = zero + 1.0;
  const Lanes factor = sum_b > zero ? (1.0 - sum_w) / (sum_b > zero ? sum_b : one) : zero;
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

#if defined(__AVX512F__)
constexpr uint32_t kFloats = 16;
#elif defined(__AVX__)
constexpr uint32_t kFloats = 8;
#else
constexpr uint32_t kFloats = 4;
#endif
/// A vector register of floats.
using Floats = float __attribute__((vector_size(kFloats * sizeof(float))));

using Doubles = double __attribute__((vector_size(kFloats * sizeof(double))));

void combine(const float* tile, uint32_t plane_count, const float* scale, const double mean[3],
             float (*out)[kTileRows]) {
  constexpr uint32_t kVectors = 2;  // by three axes: all sums stay in registers
  for (uint32_t i = 0; i < kTileRows; i += kFloats * kVectors) {
    Floats total[3][kVectors] = {};
    for (uint32_t k = 0; k < plane_count; ++k) {
      Floats values[kVectors];
      std::memcpy(values, tile + size_t{k} * kTileRows + i, sizeof values);
      for (uint32_t a = 0; a < 3; ++a) {
        for (uint32_t j = 0; j < kVectors; ++j)
          total[a][j] += scale[a * plane_count + k] * values[j];
      }
    }
    for (uint32_t a = 0; a < 3; ++a) {
      for (uint32_t j = 0; j < kVectors; ++j) {
        const Doubles moved = __builtin_convertvector(total[a][j], Doubles) + mean[a];
        const Floats rounded = __builtin_convertvector(moved, Floats);
        std::memcpy(out[a] + i + j * kFloats, &rounded, sizeof rounded);
      }
    }
  }
}

}  // namespace

extern const Kernels kKernels;
const Kernels kKernels = {accumulate, solve, combine};

}  // namespace reeb::REEB_KERNEL_NAMESPACE
