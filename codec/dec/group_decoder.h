// Decoder of one group of frames.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/container.h"
#include "bitstream/status.h"
#include "codec/common/base/stop.h"
#include "codec/common/fast/lane_weights.h"
#include "codec/common/fields/group_state.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/synthesis/synthesis.h"

namespace reeb {

/// A shot's reference mesh, ready to predict on.
struct DecodedSurface {
  std::vector<int32_t> grid;  ///< V x 3
  SurfaceGraph surface;
  LaneStart lanes;               ///< of a plain mesh; else empty
  std::vector<uint32_t> output;  ///< row of the surface graph -> vertex in output order
  float origin[3] = {0, 0, 0};   ///< of the grid, world units
  float grid_step = 0;           ///< world units
};

/// Decodes `count` components of the coefficient section; false where it is damaged, or `stop` is
/// requested.
bool decode_coefficients(std::span<const uint8_t> bytes, uint32_t count, Field& field,
                         const StopToken& stop = {});

/// Decodes a group. One that continues another needs the state which that one left; with `keep`,
/// `state` is then what this group leaves, otherwise it is used up. kCancelled soon after `stop` is
/// requested.
Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    bool keep, GroupState& state, GroupSynthesis& out, const StopToken& stop = {});

}  // namespace reeb
