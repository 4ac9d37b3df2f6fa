// Positions in a unit of their own, so that thresholds mean the same in every unit of the input.
#pragma once

#include <span>
#include <vector>

namespace reeb::segmentation {

struct OwnUnit {
  std::vector<float> positions;  ///< the largest finite magnitude is 1 .. 2, or all are 0
  double unit = 1;               ///< a power of two: of the positions, in that of the input
};
OwnUnit in_own_unit(std::span<const float> positions);

}  // namespace reeb::segmentation
