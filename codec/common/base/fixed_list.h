// List of a few elements, kept in place.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace reeb {

/// At most N elements: callers see to it.
template <class T, size_t N>
class FixedList {
 public:
  void push_back(const T& x) { items_[size_++] = x; }
  void push_front(const T& x) {
    std::copy_backward(begin(), end(), end() + 1);
    items_[0] = x;
    ++size_;
  }

  /// New elements are those that are written behind `end` before or after.
  void resize(size_t size) { size_ = static_cast<uint32_t>(size); }

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](size_t i) const { return items_[i]; }
  T* begin() { return items_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return begin() + size_; }

 private:
  std::array<T, N> items_;
  uint32_t size_ = 0;
};

}  // namespace reeb
