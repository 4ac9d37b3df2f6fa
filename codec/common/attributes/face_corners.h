// The corners of polygons, and which lie beside each other at the same vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/base/sequence.h"
#include "codec/common/mesh/connectivity.h"

namespace reeb {

/// Edges start at corners: that of corner c runs to the next corner of its face.
struct FaceCorners {
  explicit FaceCorners(const Connectivity& connectivity);

  uint32_t count() const { return static_cast<uint32_t>(vertex.size()); }
  uint32_t next(uint32_t corner) const {
    return corner + 1 < first[face[corner] + 1] ? corner + 1 : first[face[corner]];
  }
  uint32_t previous(uint32_t corner) const {
    return corner > first[face[corner]] ? corner - 1 : first[face[corner] + 1] - 1;
  }

  const std::vector<uint32_t>& vertex;  ///< of each corner; of the connectivity, which must stay
  std::vector<uint32_t> first;          ///< corner of each face; one more at the end
  std::vector<uint32_t> face;           ///< of each corner
  /// The corner whose edge runs the other way; kNoTwin where the two vertices are not joined by
  /// exactly two edges of opposite direction.
  std::vector<uint32_t> twin;
};

}  // namespace reeb
