// Vectors of the instruction set that kernels are being compiled for. Nothing here may be shared
// between instruction sets, hence the namespaces without a name.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace reeb {

namespace {

#if defined(__AVX512F__)
constexpr uint32_t kFloats = 16;
#elif defined(__AVX__)
constexpr uint32_t kFloats = 8;
#else
constexpr uint32_t kFloats = 4;
#endif
/// A vector register of floats.
using Floats = float __attribute__((vector_size(kFloats * sizeof(float))));

/// A register of doubles: GCC 12 takes wider vectors apart in memory.
constexpr uint32_t kDoubles = kFloats / 2;
using Doubles = double __attribute__((vector_size(kDoubles * sizeof(double))));
/// As many floats.
using HalfFloats = float __attribute__((vector_size(kDoubles * sizeof(float))));

template <class V>
using Element = std::remove_reference_t<decltype(std::declval<V&>()[0])>;
template <class V>
constexpr uint32_t kCount = sizeof(V) / sizeof(Element<V>);

template <class V, class T>
inline V load(const T* from) {
  V out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

template <class V, class T>
inline void store(T* to, const V& values) {
  std::memcpy(to, &values, sizeof values);
}

/// The elements of an array, without a member of it: inline members of containers, compiled for one
/// instruction set, could be linked in for all.
template <class T, size_t n>
inline const T* elements(const std::array<T, n>& from) {
  return reinterpret_cast<const T*>(&from);
}

/// x[from], y[from], x[from + 1], y[from + 1], ...
template <uint32_t from, class V, uint32_t... l>
inline V interleave(V x, V y, std::integer_sequence<uint32_t, l...>) {
  return __builtin_shufflevector(x, y, (from + l / 2 + l % 2 * sizeof...(l))...);
}

/// out[i][l] = in[l][i]. A perfect shuffle of all elements rotates the bits of their index: as many
/// as there are bits in l make it i.
template <class V>
inline void transpose(const V* in, V* out) {
  constexpr uint32_t n = kCount<V>;
  constexpr auto kEach = std::make_integer_sequence<uint32_t, n>();
  V turns[2][n];
  for (uint32_t i = 0; i < n; ++i) turns[0][i] = in[i];
  uint32_t turn = 0;
  for (uint32_t done = 1; done < n; done *= 2) {
    const V* from = turns[turn];
    turn ^= 1;
    for (uint32_t i = 0; i < n / 2; ++i) {
      turns[turn][2 * i] = interleave<0>(from[i], from[i + n / 2], kEach);
      turns[turn][2 * i + 1] = interleave<n / 2>(from[i], from[i + n / 2], kEach);
    }
  }
  for (uint32_t i = 0; i < n; ++i) out[i] = turns[turn][i];
}

}  // namespace

}  // namespace reeb
