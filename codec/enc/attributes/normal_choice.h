// Finds out whether normals need to be coded at all.
#pragma once

#include <functional>
#include <span>

#include "codec/common/attributes/site_mesh.h"
#include "codec/enc/attributes/attribute_encoder.h"

namespace reeb {

/// Decoded positions of frame t of the shot, xyz of the vertices; valid until the next call.
using FramePositions = std::function<std::span<const float>(uint32_t)>;

/// True where the attribute asks for it and its normals may be computed from positions, and `out`
/// is all that a decoder needs for that.
bool compute_normals(const Attribute& attribute, const ShotSurface& surface, uint32_t frame_count,
                     const FramePositions& positions, CodedAttribute& out);

}  // namespace reeb
