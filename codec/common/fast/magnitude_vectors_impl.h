// What the fast profile expects of magnitudes, and the classes that it gives, for a vector of
// 32-bit integers: lanes of a block, or the axes of a position. Compiled for several instruction
// sets, hence the namespace without a name.
#pragma once

#include <cstdint>

#include "entropy/rans.h"

namespace reeb {

namespace {

template <class V>
struct FloatsFor {
  typedef float Type __attribute__((vector_size(sizeof(V))));
};

/// Classes by the expected magnitude, in 1/16, half an octave each.
template <class V>
inline V magnitude_class(const V& expected) {
  constexpr auto kLast = static_cast<int32_t>(kRansClasses) - 1;
  const auto size = __builtin_convertvector(expected + 1, typename FloatsFor<V>::Type);
  const V cls = (reinterpret_cast<V>(size) >> 22) - 254;
  return cls < kLast ? cls : V{} + kLast;
}

/// The mean of a sum of `count` magnitudes, in 1/16.
template <class V>
inline V mean_magnitude(const V& sum, uint32_t count) {
  return (sum * static_cast<int32_t>(65536 / count)) >> 12;
}

/// What neighbours and the recent past let expect.
template <class V>
inline V expected_magnitude(const V& near, const V& recent) {
  return (10 * near + 6 * recent) >> 4;
}

/// |n|, up to 255.
template <class V>
inline V noted_magnitude(const V& n) {
  constexpr int32_t kMax = 255;
  const V size = n < 0 ? -n : n;
  return size < kMax ? size : V{} + kMax;
}

/// A decaying mean of magnitudes, in 1/256, after one more.
template <class V>
inline V decayed(const V& running, const V& magnitude) {
  return running + magnitude * 32 - (running >> 3);
}

}  // namespace

}  // namespace reeb
