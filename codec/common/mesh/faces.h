// Faces compared without regard to their order and first corners, which a stream need not keep, and
// their triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb {

/// The corners (at least one) rotated so that the smallest sequence comes out; orientation is kept.
std::vector<uint32_t> canonical_cycle(std::span<const uint32_t> corners);

/// True where both have the same vertex count and the same faces, each as often.
bool same_faces(const Connectivity& a, const Connectivity& b);

/// Triangles of faces as in Connectivity: fans around the first corner. Writes 3 * (sum of (size -
/// 2) over sizes >= 3) vertices to `out`, and returns how many; nullptr only counts.
size_t fan_triangles(std::span<const uint32_t> face_sizes, std::span<const uint32_t> corners,
                     uint32_t* out);

/// The same in a vector of their own.
std::vector<uint32_t> fan_triangles(const Connectivity& connectivity);

}  // namespace reeb
