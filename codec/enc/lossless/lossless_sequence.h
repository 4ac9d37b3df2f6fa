// Lossless encoding of a sequence in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

inline constexpr int kQuickEffort = 3;  ///< up to this effort the quick method is used

struct LosslessOptions {
  double step = 0;         ///< nearly all coordinates are multiples of it; 0 where nothing is known
  bool face_order = true;  ///< faces come back in order, with their first corners
};

/// As `encode`, whose pre-conditions hold, with Target::kLossless.
Status encode_lossless(const Sequence& sequence, const EncodeOptions& options,
                       const LosslessOptions& lossless, std::vector<uint8_t>& out,
                       EncodeStats& stats);

}  // namespace reeb
