// How much memory decoding takes, known before any of it is allocated.
#pragma once

#include <cstdint>

#include "bitstream/container.h"
#include "codec/common/base/sequence.h"
#include "codec/dec/group_decoder.h"

namespace reeb {

/// Bytes that decoding a reference mesh and preparing it for prediction takes at most;
/// `coded_triangles`: that its connectivity announces.
uint64_t reference_memory(const MeshHeader& header, uint64_t coded_triangles);

/// Bytes that decoding a group takes at most, beside its shot; `keep`: what it learns stays,
/// for the next one.
uint64_t group_memory(uint64_t vertices, const GroupHeader& header, bool keep);

/// Bytes that what a group has learned takes, for the next one.
uint64_t state_memory(uint64_t vertices);

/// Bytes that stay.
uint64_t kept_memory(const DecodedSurface& surface);
uint64_t kept_memory(uint64_t vertices, const GroupHeader& header);
uint64_t kept_memory(const Connectivity& connectivity);

}  // namespace reeb
