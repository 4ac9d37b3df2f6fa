// Half-edges of triangle lists, and polygons put together from triangles.
//
// Half-edge 3t+i of triangle t runs from its corner i to its corner (i+1) % 3.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/common/mesh/half_edge_fans.h"

namespace reeb {

inline constexpr uint32_t kNoTwin = std::numeric_limits<uint32_t>::max();

inline uint32_t next_half_edge(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// The half-edge that runs the other way along each half-edge's edge; kNoTwin where the edge does
/// not have exactly two half-edges of opposite direction. `triangles`: three vertices each.
std::vector<uint32_t> pair_half_edges(std::span<const uint32_t> triangles);
/// The same where the fans are there already.
std::vector<uint32_t> pair_half_edges(std::span<const uint32_t> triangles,
                                      const HalfEdgeFans& fans);

/// Polygons as `sizes` and `corners` (see Connectivity), ordered by their first triangle.
struct Polygons {
  std::vector<uint32_t> sizes;
  std::vector<uint32_t> corners;
};

/// Joins triangles across the half-edges marked in `diagonal` (both twins or none); a polygon
/// starts at the first unmarked half-edge of its first triangle. False where the triangles of a
/// polygon do not form a tree, so that it has no single boundary.
bool join_triangles(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
                    std::span<const uint8_t> diagonal, Polygons& out);

}  // namespace reeb
