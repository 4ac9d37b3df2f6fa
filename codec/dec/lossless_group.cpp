#include <utility>

#include "codec/common/lossless/lossless_syntax.h"
#include "codec/common/lossless/surface_start.h"
#include "codec/common/synthesis/exact_frames.h"
#include "codec/dec/group_parts.h"
#include "codec/dec/profile_groups.h"
#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"

namespace reeb {

namespace {

Status decode_frames(const GroupTask& task, ExactFrames& out) {
  Status damaged = Status::corrupt("the frames of a lossless group are damaged");
  const GroupHeader& h = task.header();
  const DecodedSurface& surface = task.decoded;
  BinaryDecoder bits(task.chunk.differences);
  RawBitReader raw(task.chunk.raw);
  NumberSets sets;
  if (!code_number_sets(raw, sets)) return damaged;
  FrameCoder coder(surface.surface.graph,
                   start_positions(surface.surface.points(), surface.surface.order, surface.origin,
                                   surface.grid_step),
                   sets, (h.flags & GroupHeader::kQuick) != 0, task.threads, task.stop);
  RepeatSyntax repeats;
  while (out.frame_count() < h.frame_count) {
    if (task.stop.requested()) return Status::cancelled();
    const uint32_t distance = repeats.code(bits, 0);
    if (distance > out.frame_count()) return damaged;
    if (distance > 0) {
      out.repeat(distance);
      coder.jump(out[out.frame_count() - 1]);
      continue;
    }
    if (out.stored_count() == h.stored_count) return damaged;
    std::vector<float> frame(3 * surface.output.size());
    if (!coder.code(bits, raw, frame.data()) || bits.overrun() || raw.overrun()) return damaged;
    out.add(std::move(frame));
  }
  return out.stored_count() == h.stored_count && raw.at_end() ? Status() : damaged;
}

}  // namespace

Status decode_lossless_group(const GroupTask& task, GroupSynthesis& out) {
  if (Status s = refuse_plain(task); !s.ok()) return s;
  if (task.header().stored_count > task.header().frame_count)
    return Status::corrupt("stored_count does not fit the group's frames");
  ExactFrames frames;
  if (Status s = decode_frames(task, frames); !s.ok()) return s;
  out = GroupSynthesis(std::move(frames), task.decoded.output);
  return {};
}

}  // namespace reeb
