// Nearest vertices among those that are decoded before a given one.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/mesh/grid.h"

namespace reeb {

/// Tries all vertices where they are few, or queries are; else by a k-d tree over the vertices of
/// the reference mesh, made when first needed. Every node knows the lowest rank (position in the
/// coding order) below it, so that a query skips what is not decoded yet.
class EarlierNeighbours {
 public:
  /// `order`: the vertices in coding order; `rank[v]`: place of vertex v there. All must outlive
  /// the object.
  EarlierNeighbours(const GridPoints& points, const std::vector<uint32_t>& order,
                    const std::vector<uint32_t>& rank)
      : points_(points), order_(order), rank_(rank) {}

  /// Up to `k` vertices of lower rank nearest to v, nearest first, ties by index.
  std::vector<uint32_t> find(uint32_t v, uint32_t k);

 private:
  struct Node {
    uint32_t begin, end;  ///< range of items_
    uint32_t min_rank;
    uint32_t left, right;  ///< children; 0 for a leaf
    int axis;
    int32_t split;
  };
  struct Query;

  void build();
  uint32_t build(uint32_t begin, uint32_t end);
  void try_vertex(uint32_t u, Query& query) const;
  void visit(uint32_t node, Query& query) const;

  const GridPoints& points_;
  const std::vector<uint32_t>& order_;
  const std::vector<uint32_t>& rank_;
  std::vector<uint32_t> items_;
  std::vector<Node> nodes_;  ///< empty before the tree is needed
  uint64_t tried_ = 0;       ///< vertices, without a tree
};

}  // namespace reeb
