// Rows of a prediction graph, an element of a vector each, in binary64 or binary32: `V`, which has
// kCount<V> of them.
#pragma once

#include <cstdint>

#include "codec/common/base/packed_matrix.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/prediction/row_solver_impl.h"
#include "codec/common/simd/vectors_impl.h"

namespace reeb {

namespace {

template <class V>
struct FloatChunk {
  static constexpr uint32_t kSize = kCount<V> < 8 ? kCount<V> : 8;
  typedef float Type __attribute__((vector_size(kSize * sizeof(float))));
};
/// Floats that are read and written together: one or more chunks make up a V.
template <class V>
using Chunk = typename FloatChunk<V>::Type;
template <class V>
constexpr uint32_t kChunks = kCount<V> / kCount<Chunk<V>>;

template <class V>
inline V join(const Chunk<V>* chunks) {
  if constexpr (kChunks<V> == 1) {
    return __builtin_convertvector(chunks[0], V);
  } else {
    static_assert(kCount<V> == 16);
    return __builtin_shufflevector(chunks[0], chunks[1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
                                   13, 14, 15);
  }
}

template <class V>
inline Chunk<V> chunk_of(const V& values, uint32_t chunk) {
  if constexpr (kChunks<V> == 1) return __builtin_convertvector(values, Chunk<V>);
  return load<Chunk<V>>(reinterpret_cast<const float*>(&values) + chunk * kCount<Chunk<V>>);
}

/// out[k]: the k-th float of the chunk from(l), of every row l.
template <class V, class From>
inline void gather(From from, V* out) {
  constexpr uint32_t kWidth = kCount<Chunk<V>>;
  Chunk<V> in[kWidth];
  Chunk<V> turned[kChunks<V>][kWidth];
  for (uint32_t c = 0; c < kChunks<V>; ++c) {
    for (uint32_t l = 0; l < kWidth; ++l) in[l] = from(c * kWidth + l);
    transpose(in, turned[c]);
  }
  for (uint32_t k = 0; k < kWidth; ++k) {
    Chunk<V> chunks[kChunks<V>];
    for (uint32_t c = 0; c < kChunks<V>; ++c) chunks[c] = turned[c][k];
    out[k] = join<V>(chunks);
  }
}

template <class V>
struct Rows {
  const PredictionGraph::Row* row[kCount<V>];
  const uint32_t* index;
  uint32_t count = 0;  ///< the most neighbours that one has
  V counts;
  V rings;
};

template <class V>
inline Rows<V> rows_of(const PredictionGraph::Row* all, const uint32_t* indices) {
  Rows<V> out;
  out.index = indices;
  for (uint32_t l = 0; l < kCount<V>; ++l) {
    out.row[l] = all + indices[l];
    out.count = out.row[l]->count > out.count ? out.row[l]->count : out.count;
    out.counts[l] = out.row[l]->count;
    out.rings[l] = out.row[l]->ring;
  }
  return out;
}

/// Adds what is expected of the weights to the matrix, with the given precision of a neighbour in
/// the ring and beyond it, and writes the right sides: w, and ones where there is a neighbour.
template <class V>
inline void expect(const Rows<V>& rows, Element<V> ring, Element<V> beyond, V* a) {
  constexpr uint32_t kWidth = kCount<Chunk<V>>;
  const uint32_t n = rows.count;
  V* const w = a + packed(n, 0);
  V* const ones = a + packed(n + 1, 0);
  const V zero{};
  for (uint32_t first = 0; first < n; first += kWidth) {
    V prior[kWidth];
    V precision[kWidth];
    const auto from = [&](const auto& array) { return load<Chunk<V>>(elements(array) + first); };
    gather<V>([&](uint32_t l) { return from(rows.row[l]->prior); }, prior);
    gather<V>([&](uint32_t l) { return from(rows.row[l]->precision); }, precision);
    for (uint32_t k = 0; k < kWidth && first + k < n; ++k) {
      const uint32_t i = first + k;
      const V place = zero + static_cast<Element<V>>(i);
      const V sure = precision[k] * (place < rows.rings ? zero + ring : zero + beyond);
      a[packed(i, i)] += sure;
      w[i] = prior[k] * sure;
      ones[i] = place < rows.counts ? zero + 1 : zero;
    }
  }
}

/// n weights of every row l, and zeros up to kMaxNeighbours, to out[l].
template <class V>
inline void store_weights(const V* w, uint32_t n, float* const* out) {
  constexpr uint32_t kWidth = kCount<Chunk<V>>;
  for (uint32_t first = 0; first < kMaxNeighbours; first += kWidth) {
    for (uint32_t c = 0; c < kChunks<V>; ++c) {
      Chunk<V> in[kWidth] = {};
      Chunk<V> turned[kWidth];
      for (uint32_t k = 0; k < kWidth && first + k < n; ++k) in[k] = chunk_of(w[first + k], c);
      transpose(in, turned);
      for (uint32_t l = 0; l < kWidth; ++l) store(out[c * kWidth + l] + first, turned[l]);
    }
  }
}

}  // namespace

}  // namespace reeb
