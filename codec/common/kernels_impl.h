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

template <class V, class T>
inline V load(const T* from) {
  V out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

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

template <class T, uint32_t kCount>
struct VectorOf {
  typedef T Type __attribute__((vector_size(kCount * sizeof(T))));
};

/// Element by element. In halves without AVX-512: of vectors wider than the processor's GCC 12
/// converts single elements.
template <class To, class From, uint32_t kCount = kRansLanes>
inline typename VectorOf<To, kCount>::Type convert(
    const typename VectorOf<From, kCount>::Type& from) {
#if defined(__AVX512F__)
  return __builtin_convertvector(from, typename VectorOf<To, kCount>::Type);
#else
  typename VectorOf<From, kCount / 2>::Type in[2];
  std::memcpy(in, &from, sizeof in);
  using Half = typename VectorOf<To, kCount / 2>::Type;
  const Half out[2] = {__builtin_convertvector(in[0], Half), __builtin_convertvector(in[1], Half)};
  return load<typename VectorOf<To, kCount>::Type>(out);
#endif
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
  const LanesU running = load<LanesU>(b.before) >> 4;
  LanesU near = running;
  if (ring > 0) {
    Lanes16 sum{};
    for (uint32_t i = 0; i < ring; ++i)
      sum += load<Lanes16>(b.magnitudes + size_t{neighbour[i]} * kRansLanes);
    near = convert<uint32_t, uint16_t>(sum) * (65536 / ring) >> 12;
  }
  const LanesU expected = b.history != nullptr ? (3 * near + 3 * running + 10 * b.history[row]) >> 4
                                               : (10 * near + 6 * running) >> 4;
  const LanesF size = convert<float, int32_t>(reinterpret_cast<LanesI>(expected + 1));
  const LanesU cls = (reinterpret_cast<LanesU>(size) >> 22) - 254;
  return cls < kRansClasses - 1 ? cls : LanesU{} + (kRansClasses - 1);
}

inline void note_vectors(LaneBlock& b, uint32_t row, LanesF prediction, LanesI n) {
  constexpr int32_t kMostMagnitude = 255;
  const LanesF value = prediction + convert<float, int32_t>(n) * b.steps[row];
  std::memcpy(b.values + size_t{row} * kRansLanes, &value, sizeof value);
  const LanesI size = n < 0 ? -n : n;
  const LanesI capped = size < kMostMagnitude ? size : LanesI{} + kMostMagnitude;
  const auto magnitude = convert<uint16_t, int32_t>(capped);
  std::memcpy(b.magnitudes + size_t{row} * kRansLanes, &magnitude, sizeof magnitude);
  LanesU running = load<LanesU>(b.running);
  std::memcpy(b.before, &running, sizeof running);
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

#if defined(__AVX512VNNI__)
/// RansDecoder::get for all lanes at once. Intrinsics without a mask would leave GCC 12 in doubt
/// whether their results are initialised.
class LaneDecoder {
 public:
  LaneDecoder(RansDecoder& decoder, uint32_t lanes)
      : decoder_(decoder),
        lanes_(static_cast<__mmask16>((1u << lanes) - 1)),
        state_(load<LanesU>(decoder.cursor().state)) {}
  ~LaneDecoder() { std::memcpy(decoder_.cursor().state, &state_, sizeof state_); }
  LaneDecoder(const LaneDecoder&) = delete;
  LaneDecoder& operator=(const LaneDecoder&) = delete;

  [[gnu::always_inline]] LanesI get(const LanesU& cls) {
    constexpr __mmask16 kAll = 0xFFFF;
    RansCursor& cursor = decoder_.cursor();
    const LanesU index = (cls << kRansBits) | (state_ & ((1u << kRansBits) - 1));
    const auto slot = reinterpret_cast<LanesU>(_mm512_mask_i32gather_epi32(
        _mm512_setzero_si512(), kAll, reinterpret_cast<__m512i>(index), cursor.slots, 4));
    const LanesU x = (slot & 0xFFF) * (state_ >> kRansBits) + (slot >> 12 & 0xFFF);
    const __mmask16 low = _mm512_mask_cmplt_epu32_mask(lanes_, reinterpret_cast<__m512i>(x),
                                                       _mm512_set1_epi32(1 << 16));
    const __m512i words = _mm512_maskz_cvtepu16_epi32(
        kAll, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(cursor.words + cursor.at)));
    const __m512i next =
        _mm512_mask_or_epi32(reinterpret_cast<__m512i>(x), low, reinterpret_cast<__m512i>(x << 16),
                             _mm512_maskz_expand_epi32(low, words));
    state_ = reinterpret_cast<LanesU>(
        _mm512_mask_mov_epi32(reinterpret_cast<__m512i>(state_), lanes_, next));
    cursor.at += static_cast<uint32_t>(__builtin_popcount(low));
    decoder_.settle();
    return integers(reinterpret_cast<LanesU>(
        _mm512_maskz_mov_epi32(lanes_, reinterpret_cast<__m512i>(slot >> 24))));
  }

 private:
  [[gnu::always_inline]] LanesI integers(const LanesU& symbol) {
    auto out = reinterpret_cast<LanesI>((symbol >> 1) ^ -(symbol & 1));
    uint32_t large = _mm512_cmpgt_epu32_mask(reinterpret_cast<__m512i>(symbol),
                                             _mm512_set1_epi32(kRansLastSingle));
    for (; large != 0; large &= large - 1) {
      const auto lane = static_cast<uint32_t>(__builtin_ctz(large));
      out[lane] = decoder_.large(symbol[lane]);
    }
    return out;
  }

  RansDecoder& decoder_;
  __mmask16 lanes_;
  LanesU state_;
};
#else
/// RansDecoder::get for one lane after another.
class LaneDecoder {
 public:
  LaneDecoder(RansDecoder& decoder, uint32_t lanes) : decoder_(decoder), lanes_(lanes) {}

  [[gnu::always_inline]] LanesI get(const LanesU& classes) {
    uint32_t cls[kRansLanes];
    std::memcpy(cls, &classes, sizeof cls);
    int32_t n[kRansLanes] = {};
    for (uint32_t l = 0; l < lanes_; ++l) n[l] = decoder_.get(l, cls[l]);
    decoder_.settle();
    return load<LanesI>(n);
  }

 private:
  RansDecoder& decoder_;
  uint32_t lanes_;
};
#endif

void decode_lanes(LaneBlock& b, RansDecoder& decoder, uint32_t lanes) {
  LaneDecoder coder(decoder, lanes);
  for (uint32_t row = 0; row < b.row_count; ++row) {
    const LanesF prediction = predict_lanes(b, row);
    note_vectors(b, row, prediction, coder.get(classify_lanes(b, row)));
  }
}

}  // namespace

extern const Kernels kKernels;
const Kernels kKernels = {observe_points, load_equations, store_equations, fold,        solve,
                          combine,        guess_lanes,    note_lanes,      decode_lanes};

}  // namespace reeb::REEB_KERNEL_NAMESPACE
