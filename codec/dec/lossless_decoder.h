// Decoder of one lossless group.
#pragma once

#include "codec/common/synthesis/exact_frames.h"
#include "codec/dec/group_decoder.h"

namespace reeb {

/// Decodes all frames of a group of the lossless profile; kCancelled soon after `stop` is
/// requested.
Status decode_lossless_group(const GroupChunk& chunk, const DecodedSurface& surface,
                             unsigned threads, const StopToken& stop, ExactFrames& out);

}  // namespace reeb
