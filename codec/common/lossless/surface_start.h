// The reference mesh as a frame: where the first frame of a lossless group is predicted from.
#pragma once

#include <vector>

#include "codec/common/mesh/grid.h"

namespace reeb {

/// Grid points in world units, [row][xyz]: origin + point * step in binary64, cut to what binary32
/// holds, rounded once. `order`: vertex of each row.
std::vector<float> start_positions(const GridPoints& points, const std::vector<uint32_t>& order,
                                   const float origin[3], float step);

}  // namespace reeb
