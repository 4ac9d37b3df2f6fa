// Reading vectors that need not be aligned; see kernels_impl.h.
#pragma once

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

}  // namespace

}  // namespace reeb::REEB_KERNEL_NAMESPACE
