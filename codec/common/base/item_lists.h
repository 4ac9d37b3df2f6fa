// Many lists of items in one array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/raw_vector.h"

namespace reeb {

template <class T>
class ItemLists {
 public:
  /// `put_all(put)` calls put(list, item) for every item, in two passes that must be the same; each
  /// list keeps the order. At most 2^32 - 1 items.
  template <class PutAll>
  ItemLists(size_t list_count, PutAll put_all) : begin_(list_count + 2) {
    // The items of list l are counted at l + 2, so that the sums up to l + 1 tell where it begins.
    // The second pass places its items from there on, which leaves at l + 1 where list l + 1
    // begins.
    put_all([this](size_t list, const T&) { ++begin_[list + 2]; });
    for (size_t l = 2; l < begin_.size(); ++l) begin_[l] += begin_[l - 1];
    items_.resize(begin_.back());
    put_all([this](size_t list, const T& item) { items_[begin_[list + 1]++] = item; });
  }

  size_t size() const { return begin_.size() - 2; }
  std::span<const T> operator[](size_t list) const {
    return std::span(items_).subspan(begin_[list], begin_[list + 1] - begin_[list]);
  }
  /// Of all lists, one after another.
  std::span<const T> items() const { return items_; }

 private:
  std::vector<uint32_t> begin_;
  RawVector<T> items_;
};

}  // namespace reeb
