// Finds out how little of normals needs to be coded: those that follow from positions, nothing;
// others, how they are turned from these.
#pragma once

#include <functional>
#include <span>

#include "codec/common/attributes/attribute_syntax.h"
#include "codec/enc/attributes/attribute_encoder.h"

namespace reeb {

/// Decoded positions of frame t of the shot, xyz of the vertices; valid until the next call.
using FramePositions = std::function<std::span<const float>(uint32_t)>;

struct ComputedNormals {
  CodedAttribute coded;
  Attribute corrections;  ///< animated, to be coded on `sites`; where coded.header.in_groups()
  Sites sites;
};

/// True where the attribute asks for it and its normals may be computed from positions, turned or
/// not, as its angles say, and `out` is all that a decoder needs for that.
bool compute_normals(const Attribute& attribute, const ShotSurface& surface, uint32_t frame_count,
                     const FramePositions& positions, ComputedNormals& out);

}  // namespace reeb
