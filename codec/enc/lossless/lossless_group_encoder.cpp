#include "codec/enc/lossless/lossless_group_encoder.h"

#include "codec/common/lossless/lossless_syntax.h"
#include "codec/common/lossless/surface_start.h"
#include "codec/enc/lossless/grid_choice.h"
#include "codec/enc/lossless/number_set_choice.h"
#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"

namespace reeb {

namespace {

/// The numbers that coordinates are taken from, and the grids of frames where those are asked for.
struct NumberChoice {
  NumberSets sets;
  std::array<GridChoice, 3> grids;
};

LosslessGroup code_group(const SurfaceContext& surface, const ExactFrames& frames,
                         NumberChoice numbers, const LosslessMethod& method, unsigned threads) {
  BinaryEncoder bits;
  RawBitWriter raw;
  code_number_sets(raw, numbers.sets);
  FrameCoder coder(surface.surface.graph,
                   start_positions(surface.surface.points(), surface.surface.order,
                                   surface.header.origin, surface.header.grid_step),
                   numbers.sets, method.quick, threads);
  RepeatSyntax repeats;
  std::vector<float> frame;
  FrameGrids wanted;
  for (uint32_t t = 0; t < frames.frame_count(); ++t) {
    if (method.stop.requested()) break;
    if (repeats.code(bits, frames.distance(t)) > 0) {
      coder.jump(frames[t]);
      continue;
    }
    frame = frames[t];
    for (uint32_t a = 0; a < 3; ++a) {
      if (numbers.sets[a].by_frame()) wanted[a] = numbers.grids[a].next(frame);
    }
    coder.code(bits, raw, frame.data(), wanted);
  }
  return {surface.rows(), frames.frame_count(), frames.stored_count(), bits.finish(), raw.finish()};
}

/// False where no axis looks as if grids of frames paid.
bool choose_grids(const ExactFrames& frames, NumberChoice& numbers) {
  bool any = false;
  for (uint32_t a = 0; a < 3; ++a) {
    if (!numbers.grids[a].choose(frames, a, numbers.sets[a])) continue;
    numbers.sets[a] = NumberSet::of_frames();
    any = true;
  }
  return any;
}

}  // namespace

LosslessGroup encode_lossless_group(const SurfaceContext& surface, const ExactFrames& frames,
                                    const LosslessMethod& method, unsigned threads) {
  NumberChoice numbers;
  for (uint32_t a = 0; a < 3; ++a) {
    numbers.sets[a] =
        method.step > 0 ? NumberSet::multiples(method.step) : choose_number_set(frames, a);
  }
  LosslessGroup out = code_group(surface, frames, numbers, method, threads);
  if (method.step > 0 || !choose_grids(frames, numbers)) return out;
  // Levels may follow each other less smoothly than the numbers they stand for: both are tried.
  LosslessGroup other = code_group(surface, frames, numbers, method, threads);
  return other.bytes() < out.bytes() ? other : out;
}

}  // namespace reeb
