// Seams: where a mesh is cut, the vertices of both sides lie at the same places.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "codec/common/mesh/half_edge_fans.h"

namespace reeb {

/// Finds the vertex that a boundary vertex may coincide with: where a neighbour along the boundary
/// coincides with another vertex, the neighbours of that one along its boundary are candidates.
class SeamFinder {
 public:
  /// `twins` as of pair_half_edges. The spans must outlive the finder.
  SeamFinder(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
             const HalfEdgeFans& fans, uint32_t point_count);

  /// Up to two coded points that `point` may coincide with.
  std::span<const uint32_t> find(uint32_t point);

  /// `point` is coded now and lies at `xyz`.
  void add(uint32_t point, std::span<const int32_t> xyz);

 private:
  static constexpr size_t kMaxFound = 2;
  static constexpr size_t kMaxNeighbours = 16;  ///< more are not looked for, against hostile fans
  /// Ends of half-edges without twins around `point`.
  void boundary_neighbours(uint32_t point, std::vector<uint32_t>& out) const;

  std::span<const uint32_t> triangles_, twins_;
  const HalfEdgeFans& fans_;
  std::vector<uint8_t> on_boundary_;  // ends of half-edges without twins
  std::vector<uint8_t> coded_;
  std::vector<uint32_t> partner_;                     // latest found at the same place
  std::unordered_map<uint64_t, uint32_t> latest_at_;  // boundary points by place
  std::vector<uint32_t> near_, far_, found_;          // scratch
};

}  // namespace reeb
