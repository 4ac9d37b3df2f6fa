// Lists per vertex of a mesh that is being collapsed: its neighbours, its triangles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <vector>

#include "codec/common/base/batches.h"

namespace reeb {

/// A list per vertex, in no order, in one block of memory. Behind the elements its room is filled
/// with what stands for none, so that loops may go by eights: processors seldom foresee where a
/// shorter one ends. A list that outgrows its room moves to the end of the block, into twice as
/// much.
class NeighbourLists {
 public:
  /// Empty lists with room for more than capacity[v] elements; `none` is no element.
  NeighbourLists(const std::vector<uint32_t>& capacity, uint32_t none) : none_(none) {
    lists_.reserve(capacity.size());
    uint32_t begin = 0;
    for (const uint32_t c : capacity) {
      const uint32_t lines = c / kLine + 1;
      lists_.push_back({begin, 0, lines * kLine});
      begin += lines * kLine;
    }
    lines_.resize(begin / kLine, empty_line());
  }

  std::span<const uint32_t> operator[](uint32_t list) const {
    return {items() + lists_[list].begin, lists_[list].size};
  }
  /// The same, filled up with none to a multiple of eight.
  std::span<const uint32_t> by_eights(uint32_t list) const {
    return {items() + lists_[list].begin, padded(lists_[list].size)};
  }

  void push_back(uint32_t list, uint32_t x) { push_back_if(true, list, x); }
  /// Without a branch on the condition.
  void push_back_if(bool condition, uint32_t list, uint32_t x) {
    List& l = lists_[list];
    items()[l.begin + l.size] = choose(condition, x, none_);
    l.size += condition ? 1 : 0;
    if (l.size == l.room) move(l);  // there is always room for one more
  }

  /// Pre-condition of both: x is in the list, once.
  void erase(uint32_t list, uint32_t x) { replace_or_erase(list, x, none_, true); }
  /// Puts `by` in the place of x or, where it `erases`, nothing; without a branch on that.
  void replace_or_erase(uint32_t list, uint32_t x, uint32_t by, bool erases) {
    List& l = lists_[list];
    uint32_t& last = items()[l.begin + l.size - 1];
    *find(list, x) = choose(erases, last, by);
    last = choose(erases, none_, last);
    l.size -= erases ? 1 : 0;
  }

  /// Keeps those for which `keep`, called once for each in turn, is true.
  template <class Keep>
  void filter(uint32_t list, Keep keep) {
    uint32_t* const all = items() + lists_[list].begin;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < lists_[list].size; ++i) {
      const uint32_t x = all[i];
      all[kept] = x;
      kept += keep(x) ? 1 : 0;
    }
    std::fill(all + kept, all + lists_[list].size, none_);
    lists_[list].size = kept;
  }

 private:
  struct List {
    uint32_t begin, size, room;
  };
  static constexpr uint32_t kLine = 16;
  struct alignas(64) Line {
    uint32_t items[kLine];
  };
  using Four = uint32_t __attribute__((vector_size(16)));

  uint32_t* items() { return lines_.data()->items; }
  const uint32_t* items() const { return lines_.data()->items; }
  Line empty_line() const {
    Line line;
    std::fill(std::begin(line.items), std::end(line.items), none_);
    return line;
  }
  static uint32_t padded(uint32_t size) { return (size + 7) / 8 * 8; }
  static uint32_t choose(bool first, uint32_t a, uint32_t b) {
    const uint32_t mask = 0u - static_cast<uint32_t>(first);  // what compilers make no branch of
    return (a & mask) | (b & ~mask);
  }

  void move(List& l) {
    const auto begin = static_cast<uint32_t>(lines_.size() * kLine);
    l.room *= 2;
    lines_.resize((begin + l.room) / kLine, empty_line());
    std::copy_n(items() + l.begin, l.size, items() + begin);
    l.begin = begin;
  }

  uint32_t* find(uint32_t list, uint32_t x) {
    uint32_t* at = items() + lists_[list].begin;
    for (;; at += 8) {
      const uint32_t place = place_among_eight(at, x);
      if (place > 0) return at + place - 1;
    }
  }

  /// 1 for the first; 0 where it is not there.
  static uint32_t place_among_eight(const uint32_t* items, uint32_t x) {
    Four low, high;
    std::memcpy(&low, items, sizeof low);
    std::memcpy(&high, items + 4, sizeof high);
    const Four wanted = {x, x, x, x};
    const Four found = (reinterpret_cast<Four>(low == wanted) & Four{1, 2, 3, 4}) |
                       (reinterpret_cast<Four>(high == wanted) & Four{5, 6, 7, 8});
    return found[0] | found[1] | found[2] | found[3];
  }

  uint32_t none_;
  BatchVector<Line> lines_;  // a list starts in one of its own
  std::vector<List> lists_;
};

}  // namespace reeb
