// Bounds the error of every coordinate of a group by corrections on top of its reconstruction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/synthesis/corrections.h"
#include "codec/common/synthesis/synthesis.h"
#include "codec/enc/reference/surface_context.h"

namespace reeb {

struct CodedCorrections {
  double step = 0;     ///< world units
  uint64_t count = 0;  ///< coordinates corrected
  std::vector<uint8_t> bytes;
  Corrections corrections;  ///< what the decoder will have
};

/// Corrections after which no coordinate of `base` misses the original by more than `bound` (> 0,
/// world units). `original`: the group's frames, xyz of the vertices in input order.
CodedCorrections encode_corrections(const GroupSynthesis& base, std::span<const float> original,
                                    const SurfaceContext& surface, double bound);

}  // namespace reeb
