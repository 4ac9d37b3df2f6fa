// Arrays for Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <vector>

namespace reeb_python {

namespace nb = nanobind;

/// A NumPy array that owns these numbers.
template <class T>
nb::object to_array(std::vector<T> numbers, std::initializer_list<size_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(numbers));
  T* const data = kept->data();
  const nb::capsule owner(kept.get(),
                          [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  (void)kept.release();
  return nb::cast(nb::ndarray<nb::numpy, T>(data, shape.size(), shape.begin(), owner));
}

/// A copy of `count` numbers.
template <class T>
nb::object to_array(const T* numbers, size_t count, std::initializer_list<size_t> shape) {
  return to_array(count > 0 ? std::vector<T>(numbers, numbers + count) : std::vector<T>(), shape);
}

}  // namespace reeb_python
