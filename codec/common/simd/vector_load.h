// Reading and writing vectors that need not be aligned; see kernels_impl.h.
#pragma once

#include <array>
#include <cstring>

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed within a file only

namespace reeb::REEB_KERNEL_NAMESPACE {

namespace {

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

/// The elements of an array, without a member of it: see ComponentTile.
template <class T, size_t N>
inline const T* elements(const std::array<T, N>& from) {
  return reinterpret_cast<const T*>(&from);
}

}  // namespace

}  // namespace reeb::REEB_KERNEL_NAMESPACE
