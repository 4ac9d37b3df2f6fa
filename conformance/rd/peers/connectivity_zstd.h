// Triangles for the peers that code positions alone: meshoptimizer's index codec, then zstd.
#pragma once

#include "conformance/rd/peers/peer.h"

namespace reeb::conformance {

/// zstd at level 19.
std::vector<uint8_t> compress_zstd(std::span<const uint8_t> bytes);
/// Empty on failure.
std::vector<uint8_t> decompress_zstd(std::span<const uint8_t> bytes);

/// Keeps the vertex numbers. The drivers count these bytes and never decode them.
std::vector<uint8_t> encode_triangles(const Connectivity& mesh);

}  // namespace reeb::conformance
