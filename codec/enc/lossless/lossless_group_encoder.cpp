#include "codec/enc/lossless/lossless_group_encoder.h"

#include "codec/common/lossless/lossless_syntax.h"
#include "codec/common/lossless/surface_start.h"
#include "codec/enc/lossless/grid_choice.h"
#include "codec/enc/lossless/number_set_choice.h"
#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"

namespace reeb {

LosslessGroup encode_lossless_group(const SurfaceContext& surface, const ExactFrames& frames,
                                    const LosslessMethod& method, unsigned threads) {
  BinaryEncoder bits;
  RawBitWriter raw;
  NumberSets sets;
  std::array<GridChoice, 3> grids;
  for (uint32_t a = 0; a < 3; ++a) {
    sets[a] = method.step > 0 ? NumberSet::multiples(method.step) : choose_number_set(frames, a);
    if (method.step == 0 && grids[a].choose(frames, a, sets[a])) sets[a] = NumberSet::of_frames();
  }
  code_number_sets(raw, sets);
  FrameCoder coder(surface.surface.graph,
                   start_positions(surface.surface.points(), surface.surface.order,
                                   surface.header.origin, surface.header.grid_step),
                   sets, method.quick, threads);
  RepeatSyntax repeats;
  std::vector<float> frame;
  FrameGrids wanted;
  for (uint32_t t = 0; t < frames.frame_count(); ++t) {
    if (repeats.code(bits, frames.distance(t)) > 0) {
      coder.jump(frames[t]);
      continue;
    }
    frame = frames[t];
    for (uint32_t a = 0; a < 3; ++a) {
      if (sets[a].by_frame()) wanted[a] = grids[a].next(frame);
    }
    coder.code(bits, raw, frame.data(), wanted);
  }
  return {surface.rows(), frames.frame_count(), frames.stored_count(), bits.finish(), raw.finish()};
}

}  // namespace reeb
