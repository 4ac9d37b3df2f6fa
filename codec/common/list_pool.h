// Many short lists in one block of memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

/// A list per vertex. A list that outgrows its place moves to the end of the block, twice as large.
class ListPool {
 public:
  /// Empty lists with room for capacity[i] elements.
  explicit ListPool(const std::vector<uint32_t>& capacity) {
    lists_.reserve(capacity.size());
    uint32_t begin = 0;
    for (const uint32_t c : capacity) {
      lists_.push_back({begin, 0, c});
      begin += c;
    }
    items_.resize(begin);
  }

  std::span<const uint32_t> operator[](uint32_t list) const {
    return {items_.data() + lists_[list].begin, lists_[list].size};
  }

  void push_back(uint32_t list, uint32_t x) { insert(list, lists_[list].size, x); }

  /// Pre-condition of these: the list is sorted. An element that is there is not inserted again.
  void insert_sorted(uint32_t list, uint32_t x) {
    const std::span<uint32_t> items = mutable_items(list);
    const auto at = std::lower_bound(items.begin(), items.end(), x);
    if (at == items.end() || *at != x) insert(list, static_cast<uint32_t>(at - items.begin()), x);
  }
  void sort_unique(uint32_t list) {
    const std::span<uint32_t> items = mutable_items(list);
    std::sort(items.begin(), items.end());
    const auto end = std::unique(items.begin(), items.end());
    lists_[list].size = static_cast<uint32_t>(end - items.begin());
  }

  void erase(uint32_t list, uint32_t x) {
    const std::span<uint32_t> items = mutable_items(list);
    const auto end = std::remove(items.begin(), items.end(), x);
    lists_[list].size = static_cast<uint32_t>(end - items.begin());
  }
  void clear(uint32_t list) { lists_[list].size = 0; }

 private:
  struct List {
    uint32_t begin, size, capacity;
  };

  std::span<uint32_t> mutable_items(uint32_t list) {
    return {items_.data() + lists_[list].begin, lists_[list].size};
  }

  void insert(uint32_t list, uint32_t at, uint32_t x) {
    List& l = lists_[list];
    if (l.size == l.capacity) move(l);
    uint32_t* const items = items_.data() + l.begin;
    std::copy_backward(items + at, items + l.size, items + l.size + 1);
    items[at] = x;
    ++l.size;
  }

  void move(List& l) {
    const auto begin = static_cast<uint32_t>(items_.size());
    l.capacity = std::max(8u, 2 * l.capacity);
    items_.resize(items_.size() + l.capacity);
    std::copy_n(items_.begin() + l.begin, l.size, items_.begin() + begin);
    l.begin = begin;
  }

  std::vector<uint32_t> items_;
  std::vector<List> lists_;
};

}  // namespace reeb
