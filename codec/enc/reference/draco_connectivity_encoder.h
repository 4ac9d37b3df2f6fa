// Encoder side of `codec/dec/draco_connectivity.h`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/dec/draco_connectivity.h"

namespace reeb {

struct DracoEncoding {
  std::vector<uint8_t> middle;      ///< see kDracoFront
  DracoMesh mesh;                   ///< what the decoder gives back
  std::vector<uint32_t> vertex_of;  ///< input vertex of each point of `mesh`
};

/// Encodes triangles over the vertices 0 .. vertex_count-1 (each used by at least one; the corners
/// of a triangle all different). False where Draco does not take them.
bool encode_draco_connectivity(std::span<const uint32_t> triangles, uint32_t vertex_count,
                               DracoEncoding& out);

}  // namespace reeb
