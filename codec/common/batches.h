// Large arrays of over-aligned structures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

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
  /// Elements that no value is given for stay as memory comes.
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
  void deallocate(T* begin, size_t) { ::operator delete(reinterpret_cast<void**>(begin)[-1]); }

  friend bool operator==(AligningAllocator, AligningAllocator) { return true; }
};

template <class Batch>
using BatchVector = std::vector<Batch, AligningAllocator<Batch>>;

}  // namespace reeb
