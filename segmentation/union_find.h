// Disjoint sets of 0 .. n-1.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace reeb::segmentation {

class UnionFind {
 public:
  explicit UnionFind(uint32_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Joins the set of `b` to that of `a`, whose representative stays. False when they were one
  /// already.
  bool unite(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[b] = a;
    return a != b;
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace reeb::segmentation
