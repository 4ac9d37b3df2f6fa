// Large arrays of over-aligned structures.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "codec/common/base/raw_vector.h"
#include "codec/common/base/stop.h"

namespace reeb {

/// Takes blocks of usual alignment and aligns within them. glibc's aligned allocation asks for more
/// than it keeps, and does not find the room again that such a block leaves: a player's heap would
/// grow to several times what is in use.
template <class T>
struct AligningAllocator {
  using value_type = T;

  AligningAllocator() = default;
  template <class U>
  AligningAllocator(const AligningAllocator<U>&) {}

  T* allocate(size_t count) {
    constexpr size_t kAlignment = alignof(T);
    static_assert(kAlignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__);
    if (count > (PTRDIFF_MAX - kAlignment) / sizeof(T)) throw std::bad_array_new_length();
    void* const block = ::operator new(count * sizeof(T) + kAlignment);
    // Blocks are aligned to at least a pointer, so there is room for one before the structures.
    char* const begin =
        static_cast<char*>(block) + kAlignment - reinterpret_cast<uintptr_t>(block) % kAlignment;
    reinterpret_cast<void**>(begin)[-1] = block;
    return reinterpret_cast<T*>(begin);
  }
  void deallocate(T* begin, size_t) { ::operator delete(reinterpret_cast<void**>(begin)[-1]); }

  friend bool operator==(AligningAllocator, AligningAllocator) { return true; }
};

/// Elements are not set to zero.
template <class Batch>
using BatchVector = std::vector<Batch, RawAllocator<Batch, AligningAllocator>>;

/// `count` batches of zeros, in pieces: pages that are touched for the first time take the system
/// longer than what is computed in them. Throws Stopped where `stop` is requested.
template <class Batch>
void make_batches(size_t count, const StopToken& stop, BatchVector<Batch>& out) {
  constexpr size_t kPiece = 256;
  out.clear();
  out.reserve(count);
  while (out.size() < count) {
    stop.check();
    out.resize(std::min(count, out.size() + kPiece), Batch{});
  }
}

}  // namespace reeb
