#include "codec/dec/lossless_decoder.h"

#include <utility>

#include "codec/common/lossless/lossless_syntax.h"
#include "codec/common/lossless/surface_start.h"
#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"

namespace reeb {

Status decode_lossless_group(const GroupChunk& chunk, const DecodedSurface& surface,
                             unsigned threads, const StopToken& stop, ExactFrames& out) {
  Status damaged = Status::corrupt("the frames of a lossless group are damaged");
  if (chunk.header.component_count > chunk.header.frame_count)
    return Status::corrupt("component_count does not fit the group's frames");
  BinaryDecoder bits(chunk.coefficients);
  RawBitReader raw(chunk.basis);
  NumberSets sets;
  if (!code_number_sets(raw, sets)) return damaged;
  FrameCoder coder(surface.surface.graph,
                   start_positions(GridPoints(surface.grid), surface.surface.order, surface.origin,
                                   surface.grid_step),
                   sets, (chunk.header.flags & GroupHeader::kQuick) != 0, threads);
  RepeatSyntax repeats;
  out = {};
  while (out.frame_count() < chunk.header.frame_count) {
    if (stop.requested()) return Status::cancelled();
    const uint32_t distance = repeats.code(bits, 0);
    if (distance > out.frame_count()) return damaged;
    if (distance > 0) {
      out.repeat(distance);
      coder.jump(out[out.frame_count() - 1]);
      continue;
    }
    if (out.stored_count() == chunk.header.component_count) return damaged;
    std::vector<float> frame(3 * surface.output.size());
    if (!coder.code(bits, raw, frame.data()) || bits.overrun() || raw.overrun()) return damaged;
    out.add(std::move(frame));
  }
  if (out.stored_count() != chunk.header.component_count || !raw.at_end()) return damaged;
  return {};
}

}  // namespace reeb
