// Bodies of the kernels of lane fields; see codec/common/kernels_impl.h.
#pragma once

#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "codec/common/fast/lane_kernels.h"
#include "codec/common/fast/magnitude_vectors_impl.h"
#include "codec/common/simd/instruction_set.h"
#include "codec/common/simd/vectors_impl.h"

namespace reeb {

namespace {

/// Lanes that are taken together. GCC 12 converts vectors wider than the processor's element by
/// element, so no more than fit one.
#if defined(__AVX512F__)
constexpr uint32_t kTogether = 16;
#else
constexpr uint32_t kTogether = 8;
#endif
using Lanes16 = uint16_t __attribute__((vector_size(kTogether * 2)));
using LanesI = int32_t __attribute__((vector_size(kTogether * 4)));
using LanesU = uint32_t __attribute__((vector_size(kTogether * 4)));
using LanesF = float __attribute__((vector_size(kTogether * 4)));

inline LanesF predict_lanes(const LaneBlock& b, uint32_t row, uint32_t first) {
  const uint32_t* neighbour = elements(b.rows[row].neighbour);
  const float* w = b.weights + size_t{row} * kMaxNeighbours;
  LanesF sum[4] = {};
  for (uint32_t i = 0; i < b.rows[row].count; i += 4) {
    for (uint32_t j = 0; j < 4; ++j)
      sum[j] += w[i + j] * load<LanesF>(b.values + size_t{neighbour[i + j]} * kRansLanes + first);
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// The mean magnitude in the ring, in 1/16; `other` where there is none.
inline LanesI near_lanes(const LaneBlock& b, uint32_t row, uint32_t first, const LanesI& other) {
  const uint32_t* neighbour = elements(b.rows[row].neighbour);
  const uint32_t ring = b.rows[row].ring;
  if (ring == 0) return other;
  Lanes16 sum{};
  for (uint32_t i = 0; i < ring; ++i)
    sum += load<Lanes16>(b.magnitudes + size_t{neighbour[i]} * kRansLanes + first);
  return mean_magnitude(__builtin_convertvector(sum, LanesI), ring);
}

/// A row's history tells more than its ring does, once there is any.
inline LanesU classify_lanes(const LaneBlock& b, uint32_t row, uint32_t first) {
  const LanesI recent = load<LanesI>(b.before + first) >> 4;
  const LanesI near = b.history != nullptr ? LanesI{} + static_cast<int32_t>(b.history[row])
                                           : near_lanes(b, row, first, recent);
  return reinterpret_cast<LanesU>(magnitude_class(expected_magnitude(near, recent)));
}

inline void note_vectors(LaneBlock& b, uint32_t row, uint32_t first, const LanesF& prediction,
                         const LanesI& n) {
  const size_t at = size_t{row} * kRansLanes + first;
  store(b.values + at, prediction + __builtin_convertvector(n, LanesF) * b.steps[row]);
  const LanesI magnitude = noted_magnitude(n);
  store(b.magnitudes + at, __builtin_convertvector(magnitude, Lanes16));
  const auto running = load<LanesI>(b.running + first);
  store(b.before + first, running);
  store(b.running + first, decayed(running, magnitude));
}

LaneGuess guess_lanes(const LaneBlock& b, uint32_t row) {
  LaneGuess out;
  for (uint32_t first = 0; first < kRansLanes; first += kTogether) {
    const LanesF prediction = predict_lanes(b, row, first);
    const LanesU cls = classify_lanes(b, row, first);
    std::memcpy(out.prediction + first, &prediction, sizeof prediction);
    std::memcpy(out.cls + first, &cls, sizeof cls);
  }
  return out;
}

void note_lanes(LaneBlock& b, uint32_t row, const LaneGuess& guess, const int32_t* n) {
  for (uint32_t first = 0; first < kRansLanes; first += kTogether)
    note_vectors(b, row, first, load<LanesF>(guess.prediction + first), load<LanesI>(n + first));
}

/// The integers of symbols; `large` is the set of lanes whose symbols have raw bits.
[[gnu::always_inline]] inline LanesI integers(RansDecoder& decoder, const LanesU& symbol,
                                              uint32_t large) {
  auto out = reinterpret_cast<LanesI>((symbol >> 1) ^ -(symbol & 1));
  for (; large != 0; large &= large - 1) {
    const auto lane = static_cast<uint32_t>(__builtin_ctz(large));
    out[lane] = decoder.large(symbol[lane]);
  }
  return out;
}

#if defined(__AVX512VNNI__)
/// RansDecoder::get for all lanes. Intrinsics without a mask would leave GCC 12 in doubt
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

  [[gnu::always_inline]] LanesI get(uint32_t /*first*/, const LanesU& cls) {
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
    const __m512i symbol = _mm512_maskz_mov_epi32(lanes_, reinterpret_cast<__m512i>(slot >> 24));
    return integers(decoder_, reinterpret_cast<LanesU>(symbol),
                    _mm512_cmpgt_epu32_mask(symbol, _mm512_set1_epi32(kRansLastSingle)));
  }

 private:
  RansDecoder& decoder_;
  __mmask16 lanes_;
  LanesU state_;
};
#elif defined(__AVX2__)
/// For each set of eight lanes, which of the next words each of them gets.
struct Spread {
  uint8_t word[256][8];
};
constexpr Spread make_spread() {
  Spread out{};
  for (uint32_t set = 0; set < 256; ++set) {
    uint8_t next = 0;
    for (uint32_t l = 0; l < 8; ++l) {
      if ((set >> l & 1) != 0) out.word[set][l] = next++;
    }
  }
  return out;
}
constexpr Spread kSpread = make_spread();

/// RansDecoder::get for eight lanes.
class LaneDecoder {
 public:
  LaneDecoder(RansDecoder& decoder, uint32_t lanes) : decoder_(decoder) {
    for (uint32_t l = 0; l < kRansLanes; ++l) used_[l] = l < lanes ? -1 : 0;
  }

  [[gnu::always_inline]] LanesI get(uint32_t first, const LanesU& cls) {
    RansCursor& cursor = decoder_.cursor();
    const auto used = load<LanesI>(used_ + first);
    const auto state = load<LanesU>(cursor.state + first);
    const LanesU index = (cls << kRansBits) | (state & ((1u << kRansBits) - 1));
    const auto slot = reinterpret_cast<LanesU>(_mm256_i32gather_epi32(
        reinterpret_cast<const int*>(cursor.slots), reinterpret_cast<__m256i>(index), 4));
    const LanesU x = (slot & 0xFFF) * (state >> kRansBits) + (slot >> 12 & 0xFFF);
    const LanesI low = (x >> 16 == 0) & used;
    const auto set = static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(low)));
    const __m256i words = _mm256_cvtepu16_epi32(
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(cursor.words + cursor.at)));
    const __m256i place =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSpread.word[set])));
    const auto word = reinterpret_cast<LanesU>(_mm256_permutevar8x32_epi32(words, place));
    const LanesU next = low ? x << 16 | word : x;
    const LanesU kept = used ? next : state;
    std::memcpy(cursor.state + first, &kept, sizeof kept);
    cursor.at += static_cast<uint32_t>(__builtin_popcount(set));
    decoder_.settle();
    const LanesU symbol = (slot >> 24) & reinterpret_cast<LanesU>(used);
    const LanesI beyond = symbol > kRansLastSingle;
    const int large = _mm256_movemask_ps(reinterpret_cast<__m256>(beyond));
    return integers(decoder_, symbol, static_cast<uint32_t>(large));
  }

 private:
  RansDecoder& decoder_;
  int32_t used_[kRansLanes];
};
#else
/// RansDecoder::get for one lane after another.
class LaneDecoder {
 public:
  LaneDecoder(RansDecoder& decoder, uint32_t lanes) : decoder_(decoder), lanes_(lanes) {}

  [[gnu::always_inline]] LanesI get(uint32_t first, const LanesU& classes) {
    uint32_t cls[kTogether];
    std::memcpy(cls, &classes, sizeof cls);
    int32_t n[kTogether] = {};
    for (uint32_t l = 0; l < kTogether && first + l < lanes_; ++l)
      n[l] = decoder_.get(first + l, cls[l]);
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
    for (uint32_t first = 0; first < lanes; first += kTogether) {
      const LanesF prediction = predict_lanes(b, row, first);
      note_vectors(b, row, first, prediction, coder.get(first, classify_lanes(b, row, first)));
    }
  }
}

}  // namespace

template <>
const LaneKernels& compiled_kernels<LaneKernels, kCompiledFor>() {
  static constexpr LaneKernels kKernels = {
      .guess = guess_lanes, .note = note_lanes, .decode = decode_lanes};
  return kKernels;
}

}  // namespace reeb
