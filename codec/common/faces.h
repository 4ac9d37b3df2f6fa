// Faces compared without regard to their order and first corners, which a stream need not keep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/sequence.h"

namespace reeb {

/// The corners (at least one) rotated so that the smallest sequence comes out; orientation is kept.
std::vector<uint32_t> canonical_cycle(std::span<const uint32_t> corners);

/// True where both have the same vertex count and the same faces, each as often.
bool same_faces(const Connectivity& a, const Connectivity& b);

}  // namespace reeb
