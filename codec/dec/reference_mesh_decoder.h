// Decoder of the reference mesh of a shot.
#pragma once

#include <cstdint>
#include <span>

#include "bitstream/limits.h"
#include "bitstream/status.h"
#include "codec/common/base/stop.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {

/// Triangles that the mesh's connectivity announces, for a look at the memory they will take; 0
/// where the bytes make no sense.
uint64_t announced_triangles(std::span<const uint8_t> bytes);

/// Decodes what `encode_reference` made. The bytes may be anything; memory and time stay within
/// what `limits` and their length justify. Throws Stopped where `stop` is requested.
Status decode_reference(std::span<const uint8_t> bytes, const Limits& limits, ReferenceMesh& out,
                        const StopToken& stop = {});

}  // namespace reeb
