// Sorting of a few numbers, where mispredicted branches are what takes time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace reeb {

inline constexpr size_t kFew = 32;

namespace detail {

using Four = int32_t __attribute__((vector_size(16)));

/// How many keys are lower than each of the first 4 * `kFours`.
template <size_t kFours>
void count_lower(std::span<const int32_t> keys, size_t count, uint32_t* lower) {
  Four own[kFours];
  Four counts[kFours] = {};
  std::memcpy(own, keys.data(), sizeof own);
  for (size_t i = 0; i < count; ++i) {
    const Four other = {keys[i], keys[i], keys[i], keys[i]};
    for (size_t k = 0; k < kFours; ++k) counts[k] -= other < own[k];
  }
  std::memcpy(lower, counts, sizeof counts);
}

}  // namespace detail

/// Sorts `items`, at most kFew, by their keys: each finds its place by counting the lower ones.
/// False, and nothing is done, where two keys are equal.
inline bool sort_few(const std::array<int32_t, kFew>& keys, std::span<uint32_t> items) {
  std::array<uint32_t, kFew> lower;
  const size_t count = items.size();
  if (count <= 8) {
    detail::count_lower<2>(keys, count, lower.data());
  } else if (count <= 16) {
    detail::count_lower<4>(keys, count, lower.data());
  } else if (count <= 24) {
    detail::count_lower<6>(keys, count, lower.data());
  } else {
    detail::count_lower<8>(keys, count, lower.data());
  }
  std::array<uint32_t, kFew> sorted;
  size_t sum = 0;  // of the places, all of which are taken where no two keys are equal
  for (size_t i = 0; i < count; ++i) {
    sorted[lower[i]] = items[i];
    sum += lower[i];
  }
  if (2 * sum != count * (count - 1)) return false;
  std::copy_n(sorted.begin(), count, items.begin());
  return true;
}

}  // namespace reeb
