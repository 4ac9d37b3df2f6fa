// Sorting of a few items without branches on what they are, which processors cannot foresee.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace reeb {

inline constexpr size_t kFew = 32;

/// `count` rounded up to eights.
constexpr size_t by_eights(size_t count) { return (count + 7) / 8 * 8; }

namespace detail {

/// How many keys are lower than each.
template <size_t kCount>
std::array<uint32_t, kCount> count_lower(const int32_t* keys) {
  using Four = int32_t __attribute__((vector_size(16)));
  Four own[kCount / 4];
  Four counts[kCount / 4] = {};
  std::memcpy(own, keys, sizeof own);
  for (size_t i = 0; i < kCount; ++i) {
    const Four other = {keys[i], keys[i], keys[i], keys[i]};
    for (size_t k = 0; k < kCount / 4; ++k) counts[k] -= other < own[k];
  }
  std::array<uint32_t, kCount> lower;
  std::memcpy(lower.data(), counts, sizeof counts);
  return lower;
}

/// The last kCount - count are no items; they come last, all with as many lower ones.
template <size_t kCount>
bool sort_few(const int32_t* keys, uint32_t* items, size_t count) {
  const std::array<uint32_t, kCount> lower = count_lower<kCount>(keys);
  std::array<uint32_t, kCount> sorted;
  std::copy_n(items, kCount, sorted.begin());
  size_t sum = 0;  // of the places, all of which are taken where no two keys are equal
  for (size_t i = 0; i < kCount; ++i) {
    sorted[lower[i]] = items[i];
    sum += lower[i];
  }
  if (2 * sum != count * (count - 1) + 2 * (kCount - count) * count) return false;
  std::copy_n(sorted.begin(), kCount, items);
  return true;
}

}  // namespace detail

/// What stands behind the keys, up to eights. The keys themselves are less.
inline constexpr int32_t kNoKey = std::numeric_limits<int32_t>::max();

/// Sorts `count` items, at most kFew, by their keys: each finds its place by counting the lower
/// ones. There is room up to by_eights(count) in both lists; what is there of `items` stays or is
/// that of another such place. False, and nothing is done, where two keys are equal.
inline bool sort_few(const int32_t* keys, uint32_t* items, size_t count) {
  if (count <= 8) return detail::sort_few<8>(keys, items, count);
  if (count <= 16) return detail::sort_few<16>(keys, items, count);
  if (count <= 24) return detail::sort_few<24>(keys, items, count);
  return detail::sort_few<32>(keys, items, count);
}

}  // namespace reeb
