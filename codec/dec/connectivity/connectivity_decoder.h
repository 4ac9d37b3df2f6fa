// Decoder of connectivity: the part of Draco's edgebreaker that reference meshes use
// (spec/connectivity.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/limits.h"
#include "bitstream/status.h"

namespace reeb {

/// Bytes that decoding takes per triangle, at most.
inline constexpr uint64_t kConnectivityMemoryPerTriangle = 96;

struct PointTriangles {
  uint32_t point_count = 0;
  std::vector<uint32_t> triangles;  ///< three different points each
};

/// The number of triangles that a section announces, 0 where it is malformed.
uint64_t connectivity_triangle_count(std::span<const uint8_t> section);

/// Decodes a section. Its counts are checked against `limits` before anything is allocated; more
/// than `max_triangles` are corrupt.
Status decode_connectivity(std::span<const uint8_t> section, const Limits& limits,
                           uint64_t max_triangles, PointTriangles& out);

}  // namespace reeb
