// Lossless coding in place of a coding with components, where that is smaller.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

/// As `encode`, whose pre-conditions hold, without a loss whatever the target; the order of faces
/// goes, as it does in a coding with components.
Status encode_exactly(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats);

/// Puts a lossless coding in the place of the one in `out`, where it is smaller or, the target
/// being a size, within it. Codes a few frames first to see whether all are worth the time.
Status offer_lossless(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats);

}  // namespace reeb
