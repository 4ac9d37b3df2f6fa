// Many short lists in one block of memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

/// A list per vertex, in no order. A list that outgrows its place moves to the end of the block,
/// twice as large.
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

  void push_back(uint32_t list, uint32_t x) {
    List& l = lists_[list];
    if (l.size == l.capacity) move(l);
    items_[l.begin + l.size++] = x;
  }

  /// Pre-condition: x is in the list, once.
  void erase(uint32_t list, uint32_t x) {
    uint32_t* const at = find(list, x);
    *at = items_[lists_[list].begin + --lists_[list].size];
  }
  void clear(uint32_t list) { lists_[list].size = 0; }

 private:
  struct List {
    uint32_t begin, size, capacity;
  };

  uint32_t* find(uint32_t list, uint32_t x) {
    uint32_t* at = items_.data() + lists_[list].begin;
    while (*at != x) ++at;
    return at;
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
