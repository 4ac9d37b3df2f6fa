// Decoder of one group of frames.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/container.h"
#include "bitstream/status.h"
#include "codec/common/base/stop.h"
#include "codec/common/fast/surface.h"
#include "codec/common/fields/group_state.h"
#include "codec/common/synthesis/synthesis.h"

namespace reeb {

/// A shot's reference mesh, ready to predict on.
struct DecodedSurface {
  Surface surface;
  std::vector<uint32_t> output;  ///< row of the surface -> vertex in output order
  float origin[3] = {0, 0, 0};   ///< of the grid, world units
  float grid_step = 0;           ///< world units
};

/// Whether the bytes of a group on so many vertices can hold what its header announces; to be asked
/// before memory is set aside for it.
Status check_elements(const GroupHeader& header, uint64_t vertices);

/// Decodes a group. One that continues another needs the state which that one left; with `keep`,
/// `state` is then what this group leaves, otherwise it is used up. kCancelled, or Stopped is
/// thrown, soon after `stop` is requested.
Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    bool keep, GroupState& state, GroupSynthesis& out, const StopToken& stop = {});

}  // namespace reeb
