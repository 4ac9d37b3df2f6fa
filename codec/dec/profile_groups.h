// A decoder of a group for each profile.
#pragma once

#include "bitstream/container.h"
#include "bitstream/status.h"
#include "codec/common/base/stop.h"
#include "codec/common/fields/group_state.h"
#include "codec/common/synthesis/synthesis.h"
#include "codec/dec/group_decoder.h"

namespace reeb {

/// What decoding a group starts from. `left`: for what the next group continues; nullptr where none
/// does. Only the main profile has such groups, and leaves anything.
struct GroupTask {
  const GroupChunk& chunk;
  const DecodedSurface& decoded;
  unsigned threads;
  GroupState& before;
  GroupState* left;
  const StopToken& stop;

  const GroupHeader& header() const { return chunk.header; }
  const Surface& surface() const { return decoded.surface; }
};

Status decode_main_group(const GroupTask& task, GroupSynthesis& out);
Status decode_fast_group(const GroupTask& task, GroupSynthesis& out);
Status decode_thesis_group(const GroupTask& task, GroupSynthesis& out);
Status decode_lossless_group(const GroupTask& task, GroupSynthesis& out);

}  // namespace reeb
