// Lossless encoding of a sequence in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

/// As `encode`, whose pre-conditions hold, with Target::kLossless. `step`: nearly all coordinates
/// are multiples of it; 0 where nothing is known.
Status encode_lossless(const Sequence& sequence, const EncodeOptions& options, double step,
                       std::vector<uint8_t>& out, EncodeStats& stats);

}  // namespace reeb
