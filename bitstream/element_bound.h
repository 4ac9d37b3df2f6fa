// How much a byte may stand for: what a file asks a decoder to hold and to do is tied to its size.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/container.h"

namespace reeb {

/// Vertices that a byte of a coded mesh may stand for at most, and faces, triangles by
/// edgebreaker and corners of listed faces.
inline constexpr uint64_t kMeshElementsPerByte = 64;
/// Elements of a byte of a group.
inline constexpr uint64_t kElementsPerByte = 512;
/// What a group's header counts for, beside the bytes of its sections.
inline constexpr uint64_t kGroupFrontBytes = 32;

/// Of all sections together.
uint64_t section_bytes(const GroupHeader& header);

/// What a group on a mesh of so many vertices holds: values of its planes, its basis and its
/// motion, coordinates of frames, and corrections, each of which counts for several.
uint64_t group_elements(const GroupHeader& header, uint64_t vertices);

/// False where the group announces more elements than its bytes may stand for.
bool within_element_bound(const GroupHeader& header, uint64_t vertices);

/// `sections` with so many zeros behind the coefficients (of a lossless group, the differences)
/// that the group is within the bound. A decoder does not see them. `padded` holds them where there
/// are any, and must outlive what is returned.
GroupSections within_element_bound(const GroupHeader& header, uint64_t vertices,
                                   GroupSections sections, std::vector<uint8_t>& padded);

}  // namespace reeb
