// Bodies of the kernels of the sum of components; see codec/common/kernels_impl.h.
#pragma once

#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "codec/common/simd/instruction_set.h"
#include "codec/common/simd/vectors_impl.h"
#include "codec/common/synthesis/sum_kernels.h"

namespace reeb {

namespace {

/// As many integers as floats in a register.
using Words = int32_t __attribute__((vector_size(kFloats * sizeof(float))));

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

constexpr uint32_t kVectors = kFloats == 16 ? 4 : 2;  // by three axes: all sums stay in registers

inline void add_wide(const ComponentTile& tile, const FrameBasis& basis, uint32_t first,
                     Floats (*sum)[kVectors]) {
  for (uint32_t k = 0; k < tile.wide_count; ++k) {
    const float* at = tile.wide + size_t{k} * kTileRows + first;
    for (uint32_t j = 0; j < kVectors; ++j) {
      const auto values = load<Floats>(at + j * kFloats);
      for (uint32_t a = 0; a < 3; ++a) sum[a][j] += basis.wide[a * tile.wide_count + k] * values;
    }
  }
}

inline void add_narrow(const ComponentTile& tile, const FrameBasis& basis, uint32_t first,
                       Words (*sum)[kVectors]) {
  for (uint32_t k = 0; k < tile.pair_count; ++k) {
    const uint32_t* at = tile.narrow + size_t{k} * kTileRows + first;
    for (uint32_t j = 0; j < kVectors; ++j) {
      const auto values = load<Words>(at + j * kFloats);
      for (uint32_t a = 0; a < 3; ++a)
        sum[a][j] = add_products(sum[a][j], values, basis.narrow[a * tile.pair_count + k]);
    }
  }
}

/// Adds the mean in binary64, a register at a time: wider vectors would be put together in memory.
inline void add_mean(double mean, float* axis) {
  for (uint32_t i = 0; i < kTileRows; i += kFloats / 2) {
    const Doubles moved = __builtin_convertvector(load<HalfFloats>(axis + i), Doubles) + mean;
    const auto rounded = __builtin_convertvector(moved, HalfFloats);
    std::memcpy(axis + i, &rounded, sizeof rounded);
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
        std::memcpy(axes[a] + first + j * kFloats, &all, sizeof all);
      }
    }
  }
  for (uint32_t a = 0; a < 3; ++a) add_mean(basis.mean[a], axes[a]);
  for (uint32_t i = 0; i < kTileRows; ++i) {
    for (uint32_t a = 0; a < 3; ++a) xyz[3 * i + a] = axes[a][i];
  }
}

}  // namespace

template <>
const SumKernels& compiled_kernels<SumKernels, kCompiledFor>() {
  static constexpr SumKernels kKernels = {.combine = combine};
  return kKernels;
}

}  // namespace reeb
