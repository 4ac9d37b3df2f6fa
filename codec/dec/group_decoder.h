// Decoder of one group of frames.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/container.h"
#include "bitstream/status.h"
#include "codec/common/prediction_graph.h"
#include "codec/common/synthesis.h"

namespace reeb {

/// A shot's reference mesh, ready to predict on.
struct DecodedSurface {
  std::vector<int32_t> grid;  ///< V x 3
  SurfaceGraph surface;
  std::vector<uint32_t> output;  ///< row of the surface graph -> vertex in output order
  float origin[3] = {0, 0, 0};   ///< of the grid, world units
};

Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    GroupSynthesis& out);

}  // namespace reeb
