// A triangle list and what is found out about it once, for all who go along its triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/mesh/connectivity.h"
#include "codec/common/mesh/half_edge_fans.h"
#include "codec/common/mesh/mesh_walk.h"

namespace reeb {

struct TriangleTopology {
  /// `list`: three points below `point_count` each; must outlive the topology.
  TriangleTopology(uint32_t point_count, std::span<const uint32_t> list)
      : triangles(list),
        fans(point_count, list),
        twins(pair_half_edges(list, fans)),
        order(position_order(point_count, list)) {}

  uint32_t point_count() const { return static_cast<uint32_t>(order.size()); }

  std::span<const uint32_t> triangles;
  HalfEdgeFans fans;
  std::vector<uint32_t> twins;  ///< see pair_half_edges
  std::vector<uint32_t> order;  ///< see position_order
};

}  // namespace reeb
