// Encoder of one lossless group.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/base/stop.h"
#include "codec/common/synthesis/exact_frames.h"
#include "codec/enc/reference/surface_context.h"

namespace reeb {

struct LosslessGroup {
  uint32_t vertex_count = 0;
  uint32_t frame_count = 0;
  uint32_t stored_count = 0;         ///< frames that are not copies
  std::vector<uint8_t> differences;  ///< range code
  std::vector<uint8_t> raw;          ///< bits at even odds

  size_t bytes() const { return differences.size() + raw.size(); }
};

struct LosslessMethod {
  bool quick = false;   ///< trades rate for speed of both directions
  double step = 0;      ///< nearly all values are multiples of it; 0 where nothing is known
  StopToken stop = {};  ///< where it is requested, the group is of no use
};

/// Encodes at least one frame, [row of the surface graph][xyz], all values finite.
LosslessGroup encode_lossless_group(const SurfaceContext& surface, const ExactFrames& frames,
                                    const LosslessMethod& method, unsigned threads);

}  // namespace reeb
