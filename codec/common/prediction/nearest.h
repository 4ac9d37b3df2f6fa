// Nearest vertices among those that are decoded before a given one.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/mesh/grid.h"

namespace reeb {

/// Tries all vertices where they are few, or queries are; else by a k-d tree over the vertices of
/// the reference mesh, made when first needed. A box of the tree knows the lowest of its vertices
/// that is decoded, so that neither vertices to come nor equal distances, of any number of vertices
/// at one place, make a query look at more than it must.
class EarlierNeighbours {
 public:
  /// `order`: the vertices in coding order; `row_of[v]`: place of vertex v there. All must outlive
  /// the object.
  EarlierNeighbours(const GridPoints& points, const std::vector<uint32_t>& order,
                    const std::vector<uint32_t>& row_of)
      : points_(points), order_(order), row_of_(row_of) {}

  /// Up to `k` vertices of rows before v's nearest to it, nearest first, ties by index.
  /// Pre-condition: no vertex of a later row was asked for before.
  std::vector<uint32_t> find(uint32_t v, uint32_t k);

  /// Vertices and boxes that were looked at.
  uint64_t work() const { return work_; }

 private:
  struct Box {
    uint32_t begin, end;         ///< range of items_
    uint32_t lowest;             ///< of its vertices that are decoded; kNone without any
    uint32_t parent;             ///< the root is its own
    uint32_t children[2];        ///< 0 for a leaf
    uint16_t least[3], most[3];  ///< of the coordinates
    uint64_t distance2(const int32_t* p) const;
  };
  struct Query;

  void build();
  uint32_t build(uint32_t begin, uint32_t end, uint32_t parent);
  Box bound(uint32_t begin, uint32_t end) const;
  /// Lets the vertices before this row be found.
  void admit(uint32_t row);
  void try_vertex(uint32_t u, Query& query);
  void visit(uint32_t box, Query& query);

  const GridPoints& points_;
  const std::vector<uint32_t>& order_;
  const std::vector<uint32_t>& row_of_;
  std::vector<uint32_t> items_;
  std::vector<Box> boxes_;         ///< empty before the tree is needed
  std::vector<uint32_t> leaf_of_;  ///< of every vertex
  uint32_t admitted_ = 0;          ///< row of the first vertex that the tree does not find yet
  uint64_t work_ = 0;
};

}  // namespace reeb
