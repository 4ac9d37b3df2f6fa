// Bodies of the displacement kernels; see codec/common/kernels_impl.h.
#pragma once

#include "codec/common/lossless/displacement_kernels.h"
#include "codec/common/prediction/row_vectors_impl.h"
#include "codec/common/simd/instruction_set.h"

namespace reeb {

namespace {

constexpr double kKept = 507.0 / 512;       // of the normal equations, from frame to frame
constexpr double kEnergyKept = 0.25;        // of the mean squared error
constexpr double kInverseVariance = 0.125;  // of a weight, as far as its prior knows
constexpr double kMinRidge = 0x1p-34;       // relative to the trace
constexpr double kTinyRidge = 1e-100;       // where nothing has moved yet
constexpr double kMaxWeight = 64;

/// The terms of one axis, term i in y[i].
inline void gather_terms(const DisplacementBatch& batch, const DisplacementFrame& frame,
                         uint32_t axis, RowValues* y) {
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    const uint32_t own = batch.self[l] * 4 + axis;
    y[0][l] = static_cast<double>(frame.before[own]);
    y[1][l] = static_cast<double>(frame.older[own]);
  }
  for (uint32_t i = kOwnTerms; i < batch.count; ++i) {
    RowValues value{};
    for (uint32_t l = 0; l < kRowsAtOnce; ++l)
      value[l] = static_cast<double>(frame.now[batch.neighbour[i][l] * 4 + axis]);
    y[i] = value * batch.in_use[i];
  }
}

void learn_displacement(DisplacementBatch& batch, const DisplacementFrame& frame) {
  const uint32_t n = batch.count;
  RowValues y[3][kMaxNeighbours];
  RowValues d[3];
  for (uint32_t a = 0; a < 3; ++a) {
    gather_terms(batch, frame, a, y[a]);
    for (uint32_t l = 0; l < kRowsAtOnce; ++l)
      d[a][l] = static_cast<double>(frame.now[batch.self[l] * 4 + a]);
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j <= i; ++j) {
      RowValues& m = batch.matrix[packed(i, j)];
      m = m * kKept + y[0][i] * y[0][j] + y[1][i] * y[1][j] + y[2][i] * y[2][j];
    }
    RowValues& g = batch.target[i];
    g = g * kKept + y[0][i] * d[0] + y[1][i] * d[1] + y[2][i] * d[2];
  }
  RowValues error{};
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) error[l] = frame.squared_error[batch.self[l]];
  batch.energy = batch.energy * kEnergyKept + error * (1 - kEnergyKept);
}

/// Of the rows from `first` on.
inline void solve_displacements(const DisplacementBatch& batch, uint32_t first, float* const* out) {
  const auto part = [first](const RowValues& of) {
    return load<Doubles>(reinterpret_cast<const double*>(&of) + first);
  };
  const uint32_t n = batch.count;
  Doubles a[kSystem];
  Doubles* const w = a + packed(n, 0);
  Doubles trace{};
  for (uint32_t i = 0; i < n; ++i) trace += part(batch.matrix[packed(i, i)]);
  const Doubles by_error = part(batch.energy) * kInverseVariance;
  const Doubles by_trace = trace * kMinRidge;
  const Doubles ridge = (by_error > by_trace ? by_error : by_trace) + kTinyRidge;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j <= i; ++j) a[packed(i, j)] = part(batch.matrix[packed(i, j)]);
    a[packed(i, i)] += ridge;
    w[i] = part(batch.target[i]) + ridge * part(batch.prior[i]);
  }
  solve_system<1>(n, a);
  for (uint32_t i = 0; i < n; ++i) {
    const Doubles zero{};
    w[i] = w[i] < kMaxWeight && w[i] > -kMaxWeight ? w[i] : zero;
  }
  store_weights(w, n, out);
}

void solve_displacement(const DisplacementBatch& batch, float* const* out) {
  for (uint32_t first = 0; first < kRowsAtOnce; first += kDoubles)
    solve_displacements(batch, first, out + first);
}

}  // namespace

template <>
const DisplacementKernels& compiled_kernels<DisplacementKernels, kCompiledFor>() {
  static constexpr DisplacementKernels kKernels = {.learn = learn_displacement,
                                                   .solve = solve_displacement};
  return kKernels;
}

}  // namespace reeb
