// Sorting of a few numbers, where mispredicted branches are what takes time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace reeb {

/// Sorts numbers that all differ. Few of them find their places by counting the lower ones.
template <class Number>
void sort_few(std::vector<Number>& numbers) {
  constexpr size_t kFew = 32;
  if (numbers.size() > kFew) {
    std::sort(numbers.begin(), numbers.end());
    return;
  }
  std::array<Number, kFew> sorted;
  for (const Number x : numbers) {
    size_t lower = 0;
    for (const Number y : numbers) lower += y < x ? 1 : 0;
    sorted[lower] = x;
  }
  std::copy_n(sorted.begin(), numbers.size(), numbers.begin());
}

}  // namespace reeb
