// Seams: where a mesh is cut, the vertices of both sides lie at the same places.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "codec/common/base/item_lists.h"
#include "codec/common/mesh/half_edge_fans.h"

namespace reeb {

/// Finds the vertex that a boundary vertex may coincide with: where a neighbour along the boundary
/// coincides with another vertex, the neighbours of that one along its boundary are candidates.
class SeamFinder {
 public:
  /// `twins` as of pair_half_edges.
  SeamFinder(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
             const HalfEdgeFans& fans, uint32_t point_count);

  /// Up to two coded points that `point` may coincide with.
  std::span<const uint32_t> find(uint32_t point);

  /// `point` is coded now and lies at `xyz`.
  void add(uint32_t point, std::span<const int32_t> xyz);

 private:
  static constexpr size_t kMaxFound = 2;

  /// Ends of half-edges without twins around each point. Found once: a point of many triangles may
  /// be asked for by as many others.
  ItemLists<uint32_t> near_;
  std::vector<uint8_t> coded_;
  std::vector<uint32_t> partner_;           ///< latest found at the same place
  std::map<uint64_t, uint32_t> latest_at_;  ///< boundary points by place, which files choose
  std::vector<uint32_t> found_;             ///< scratch
};

}  // namespace reeb
