// Draco's edgebreaker as an encoder of connectivity alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/dec/connectivity/connectivity_decoder.h"

namespace reeb {

/// What a Draco 2.2 edgebreaker file of a mesh without attributes starts with; the stream keeps
/// what is behind it.
inline constexpr std::array<uint8_t, 11> kDracoFront = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0};

struct DracoEncoding {
  std::vector<uint8_t> section;     ///< see kDracoFront
  PointTriangles mesh;              ///< what the decoder gives back
  std::vector<uint32_t> vertex_of;  ///< input vertex of each point of `mesh`
};

/// Encodes triangles over the vertices 0 .. vertex_count-1 (each used by at least one; the corners
/// of a triangle all different). False where Draco does not take them.
bool encode_draco_connectivity(std::span<const uint32_t> triangles, uint32_t vertex_count,
                               DracoEncoding& out);

}  // namespace reeb
