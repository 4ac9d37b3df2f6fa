// Bodies of the kernels, compiled once per instruction set; REEB_KERNEL_NAMESPACE tells
// which. No function here may be shared between instruction sets, hence the namespace.
#pragma once

#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "codec/common/kernels.h"
#include "codec/common/weight_kernels_impl.h"

namespace reeb::REEB_KERNEL_NAMESPACE {

namespace {

/// As many integers as floats in a register, and what holds as many doubles.
using Words = int32_t __attribute__((vector_size(kFloats * sizeof(float))));
using Doubles = double __attribute__((vector_size(kFloats * sizeof(double))));

/// sum + a b, a and b being pairs of 16-bit integers.
inline Words add_products(Words sum, Words a, uint32_t pair) {
  const Words b = Words{} + static_cast<int32_t>(pair);
#if defined(__AVX512VNNI__)
  return reinterpret_cast<Words>(_mm512_dpwssd_epi32(
      reinterpret_cast<__m512i>(sum), reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
#elif defined(__AVX2__)
  return sum + reinterpret_cast<Words>(
                   _mm256_madd_epi16(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
#elif defined(__SSE2__)
  return sum + reinterpret_cast<Words>(
                   _mm_madd_epi16(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
  return sum + ((a << 16) >> 16) * ((b << 16) >> 16) + (a >> 16) * (b >> 16);
#endif
}

constexpr uint32_t kVectors = 2;  // by three axes: all sums stay in registers

inline void add_wide(const ComponentTile& tile, const FrameBasis& basis, uint32_t first,
                     Floats (*sum)[kVectors]) {
  for (uint32_t k = 0; k < tile.wide_count; ++k) {
    Floats values[kVectors];
    std::memcpy(values, tile.wide + size_t{k} * kTileRows + first, sizeof values);
    for (uint32_t a = 0; a < 3; ++a) {
      for (uint32_t j = 0; j < kVectors; ++j)
        sum[a][j] += basis.wide[a * tile.wide_count + k] * values[j];
    }
  }
}

inline void add_narrow(const ComponentTile& tile, const FrameBasis& basis, uint32_t first,
                       Words (*sum)[kVectors]) {
  for (uint32_t k = 0; k < tile.pair_count; ++k) {
    Words values[kVectors];
    std::memcpy(values, tile.narrow + size_t{k} * kTileRows + first, sizeof values);
    for (uint32_t a = 0; a < 3; ++a) {
      for (uint32_t j = 0; j < kVectors; ++j)
        sum[a][j] = add_products(sum[a][j], values[j], basis.narrow[a * tile.pair_count + k]);
    }
  }
}

void combine(const ComponentTile& tile, const FrameBasis& basis, float* xyz) {
  float axes[3][kTileRows];
  for (uint32_t first = 0; first < kTileRows; first += kFloats * kVectors) {
    Floats wide[3][kVectors] = {};
    Words narrow[3][kVectors] = {};
    add_wide(tile, basis, first, wide);
    add_narrow(tile, basis, first, narrow);
    for (uint32_t a = 0; a < 3; ++a) {
      for (uint32_t j = 0; j < kVectors; ++j) {
        const Floats all = wide[a][j] + basis.unit * __builtin_convertvector(narrow[a][j], Floats);
        const Doubles moved = __builtin_convertvector(all, Doubles) + basis.mean[a];
        const Floats rounded = __builtin_convertvector(moved, Floats);
        std::memcpy(axes[a] + first + j * kFloats, &rounded, sizeof rounded);
      }
    }
  }
  for (uint32_t i = 0; i < kTileRows; ++i) {
    for (uint32_t a = 0; a < 3; ++a) xyz[3 * i + a] = axes[a][i];
  }
}

using Lanes16 = uint16_t __attribute__((vector_size(kRansLanes * 2)));
using LanesI = int32_t __attribute__((vector_size(kRansLanes * 4)));
using LanesU = uint32_t __attribute__((vector_size(kRansLanes * 4)));
using LanesF = float __attribute__((vector_size(kRansLanes * 4)));

template <class V, class T>
inline V load(const T* from) {
  V out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

inline LanesF predict_lanes(const LaneBlock& b, uint32_t row) {
  constexpr float kRound = 12582912.0f;  // 3 * 2^22: leaves no fraction
  const uint32_t* neighbour = b.neighbours + size_t{row} * kMaxNeighbours;
  const float* w = b.weights + size_t{row} * kMaxNeighbours;
  LanesF sum[4] = {};
  for (uint32_t i = 0; i < b.counts[row]; i += 4) {
    for (uint32_t j = 0; j < 4; ++j)
      sum[j] += w[i + j] * load<LanesF>(b.values + size_t{neighbour[i + j]} * kRansLanes);
  }
  const LanesF all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  return b.whole ? (all + kRound) - kRound : all;
}

/// Classes by the expected magnitude, half an octave each.
inline LanesU classify_lanes(const LaneBlock& b, uint32_t row) {
  const uint32_t* neighbour = b.neighbours + size_t{row} * kMaxNeighbours;
  const uint32_t ring = b.rings[row];
  const LanesU running = load<LanesU>(b.running) >> 4;
  LanesU near = running;
  if (ring > 0) {
    LanesU sum{};
    for (uint32_t i = 0; i < ring; ++i) {
      const auto m = load<Lanes16>(b.magnitudes + size_t{neighbour[i]} * kRansLanes);
      sum += __builtin_convertvector(m, LanesU);
    }
    near = sum * (65536 / ring) >> 12;
  }
  const LanesU expected = b.history != nullptr ? (3 * near + 3 * running + 10 * b.history[row]) >> 4
                                               : (10 * near + 6 * running) >> 4;
  const LanesF size = __builtin_convertvector(reinterpret_cast<LanesI>(expected + 1), LanesF);
  const LanesU cls = (reinterpret_cast<LanesU>(size) >> 22) - 254;
  return cls < kRansClasses - 1 ? cls : LanesU{} + (kRansClasses - 1);
}

inline void note_vectors(LaneBlock& b, uint32_t row, LanesF prediction, LanesI n) {
  constexpr int32_t kMostMagnitude = 1023;
  const LanesF value = prediction + __builtin_convertvector(n, LanesF) * b.steps[row];
  std::memcpy(b.values + size_t{row} * kRansLanes, &value, sizeof value);
  const LanesI size = n < 0 ? -n : n;
  const LanesI capped = size < kMostMagnitude ? size : LanesI{} + kMostMagnitude;
  const auto magnitude = __builtin_convertvector(capped, Lanes16);
  std::memcpy(b.magnitudes + size_t{row} * kRansLanes, &magnitude, sizeof magnitude);
  LanesU running = load<LanesU>(b.running);
  running += reinterpret_cast<LanesU>(capped) * 32 - (running >> 3);
  std::memcpy(b.running, &running, sizeof running);
}

LaneGuess guess_lanes(const LaneBlock& b, uint32_t row) {
  LaneGuess out;
  const LanesF prediction = predict_lanes(b, row);
  const LanesU cls = classify_lanes(b, row);
  std::memcpy(out.prediction, &prediction, sizeof prediction);
  std::memcpy(out.cls, &cls, sizeof cls);
  return out;
}

void note_lanes(LaneBlock& b, uint32_t row, const LaneGuess& guess, const int32_t* n) {
  note_vectors(b, row, load<LanesF>(guess.prediction), load<LanesI>(n));
}

void decode_lanes(LaneBlock& b, RansDecoder& decoder, uint32_t lanes) {
  alignas(32) int32_t n[kRansLanes] = {};
  alignas(32) uint32_t cls[kRansLanes];
  for (uint32_t row = 0; row < b.row_count; ++row) {
    const LanesF prediction = predict_lanes(b, row);
    const LanesU classes = classify_lanes(b, row);
    std::memcpy(cls, &classes, sizeof cls);
    for (uint32_t l = 0; l < lanes; ++l) n[l] = decoder.get(l, cls[l]);
    decoder.settle();
    note_vectors(b, row, prediction, load<LanesI>(n));
  }
}

}  // namespace

extern const Kernels kKernels;
const Kernels kKernels = {observe_points, load_equations, store_equations, fold,        solve,
                          combine,        guess_lanes,    note_lanes,      decode_lanes};

}  // namespace reeb::REEB_KERNEL_NAMESPACE
