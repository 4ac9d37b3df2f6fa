// Choice of the grids that the frames of a lossless group lie on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/lossless/frame_grid.h"
#include "codec/common/lossless/number_set.h"
#include "codec/common/synthesis/exact_frames.h"

namespace reeb {

/// The grid of the fewest levels that all of `values` (finite) lie on; none where they look like
/// none.
FrameGrid find_grid(std::vector<float> values);

/// Grids along one axis.
class GridChoice {
 public:
  /// False where grids of frames do not pay against the set of numbers.
  bool choose(const ExactFrames& frames, uint32_t axis, const NumberSet& set);
  /// Grid of the next frame that is coded ([row][xyz]), none where that is cheaper.
  FrameGrid next(std::span<const float> frame);

 private:
  uint32_t axis_ = 0;
  FrameGrid last_;
};

}  // namespace reeb
