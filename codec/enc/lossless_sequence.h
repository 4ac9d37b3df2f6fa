// Lossless encoding of a sequence in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

/// As `encode`, whose pre-conditions hold, with Target::kLossless.
Status encode_lossless(const Sequence& sequence, const EncodeOptions& options,
                       std::vector<uint8_t>& out, EncodeStats& stats);

}  // namespace reeb
