// Vectors whose elements are not set to zero before they are written.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace reeb {

/// `Memory` gives the memory. Elements that no value is given for stay as it comes, but for members
/// with initialisers.
template <class T, template <class> class Memory = std::allocator>
struct RawAllocator : Memory<T> {
  template <class U>
  struct rebind {
    using other = RawAllocator<U, Memory>;
  };

  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
};

template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace reeb
