// The half-edges around each vertex of a triangle list.
#pragma once

#include <cstdint>
#include <span>

#include "codec/common/base/item_lists.h"

namespace reeb {

class HalfEdgeFans {
 public:
  /// `triangles`: three vertices below `vertex_count` each.
  HalfEdgeFans(uint32_t vertex_count, std::span<const uint32_t> triangles)
      : half_edges_(vertex_count, [&](auto put) {
          for (uint32_t h = 0; h < triangles.size(); ++h) put(triangles[h], h);
        }) {}

  uint32_t vertex_count() const { return static_cast<uint32_t>(half_edges_.size()); }
  /// Half-edges that start at v, ascending.
  std::span<const uint32_t> operator[](uint32_t v) const { return half_edges_[v]; }

 private:
  ItemLists<uint32_t> half_edges_;
};

}  // namespace reeb
