// Bodies of the kernels of the sum of components; see codec/common/kernels_impl.h.
#pragma once

#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
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
#elif defined(__wasm_simd128__)
  return sum + reinterpret_cast<Words>(
                   wasm_i32x4_dot_i16x8(reinterpret_cast<v128_t>(a), reinterpret_cast<v128_t>(b)));
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
#if defined(__wasm_simd128__)  // clang 19 takes vectors apart to round them
  for (uint32_t i = 0; i < kTileRows; i += kFloats) {
    const v128_t from = wasm_v128_load(axis + i);
    const v128_t upper = wasm_i64x2_shuffle(from, from, 1, 0);
    const v128_t all = wasm_f64x2_splat(mean);
    const v128_t low = wasm_f64x2_add(wasm_f64x2_promote_low_f32x4(from), all);
    const v128_t high = wasm_f64x2_add(wasm_f64x2_promote_low_f32x4(upper), all);
    wasm_v128_store(axis + i, wasm_i64x2_shuffle(wasm_f32x4_demote_f64x2_zero(low),
                                                 wasm_f32x4_demote_f64x2_zero(high), 0, 2));
  }
#else
  for (uint32_t i = 0; i < kTileRows; i += kFloats / 2) {
    const Doubles moved = __builtin_convertvector(load<HalfFloats>(axis + i), Doubles) + mean;
    const auto rounded = __builtin_convertvector(moved, HalfFloats);
    std::memcpy(axis + i, &rounded, sizeof rounded);
  }
#endif
}

inline void interleave_axes(const float (*axes)[kTileRows], float* xyz) {
#if defined(__wasm_simd128__)  // clang 19 goes float by float
  for (uint32_t i = 0; i < kTileRows; i += kFloats) {
    const auto x = load<Floats>(axes[0] + i);
    const auto y = load<Floats>(axes[1] + i);
    const auto z = load<Floats>(axes[2] + i);
    const Floats xy = __builtin_shufflevector(x, y, 0, 4, 1, 5);         // x0 y0 x1 y1
    const Floats yz = __builtin_shufflevector(y, z, 1, 5, 2, 6);         // y1 z1 y2 z2
    const Floats zx = __builtin_shufflevector(z, x, 2, 7, 3, 3);         // z2 x3 z3 z3
    store(xyz + 3 * i, __builtin_shufflevector(xy, z, 0, 1, 4, 2));      // x0 y0 z0 x1
    store(xyz + 3 * i + 4, __builtin_shufflevector(yz, x, 0, 1, 6, 2));  // y1 z1 x2 y2
    store(xyz + 3 * i + 8, __builtin_shufflevector(zx, y, 0, 1, 7, 2));  // z2 x3 y3 z3
  }
#else
  for (uint32_t i = 0; i < kTileRows; ++i) {
    for (uint32_t a = 0; a < 3; ++a) xyz[3 * i + a] = axes[a][i];
  }
#endif
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
  interleave_axes(axes, xyz);
}

}  // namespace

template <>
const SumKernels& compiled_kernels<SumKernels, kCompiledFor>() {
  static constexpr SumKernels kKernels = {.combine = combine};
  return kKernels;
}

}  // namespace reeb
