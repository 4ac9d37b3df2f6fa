// Bounds the error of every coordinate by moving it to a multiple of a step, then coding lossless:
// smaller than a corrected reconstruction where motion is erratic and the bound near the precision
// of the input.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

/// As `encode`, whose pre-conditions hold, with Target::kMaxError.
Status encode_snapped(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats);

}  // namespace reeb
