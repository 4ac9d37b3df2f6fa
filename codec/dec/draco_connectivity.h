// Draco's edgebreaker as a coder of connectivity alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/limits.h"
#include "bitstream/status.h"

namespace reeb {

/// What a Draco 2.2 edgebreaker file of a mesh without attributes starts and ends with; the
/// stream keeps what is in between, so that nothing but connectivity is ever decoded from foreign
/// bytes.
inline constexpr std::array<uint8_t, 11> kDracoFront = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0};
inline constexpr std::array<uint8_t, 1> kDracoBack = {0};  // no attributes: they take time

/// Bytes that Draco takes while it decodes, per triangle; measured, with room to spare.
inline constexpr uint64_t kDracoMemoryPerTriangle = 128;

struct DracoMesh {
  uint32_t point_count = 0;
  std::vector<uint32_t> triangles;  ///< three points each
};

/// The number of triangles that `middle` announces, 0 where it is malformed.
uint64_t draco_triangle_count(std::span<const uint8_t> middle);

/// Decodes `middle`, a Draco file without its front and back. Its counts are checked against
/// `limits` before Draco sees it; more than `max_triangles` are corrupt.
Status decode_draco_connectivity(std::span<const uint8_t> middle, const Limits& limits,
                                 uint64_t max_triangles, DracoMesh& out);

}  // namespace reeb
