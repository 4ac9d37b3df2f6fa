// Numbers that the coordinates of one frame may be, along an axis: levels at equal distances, as
// formats with a grid for every frame have them.
#pragma once

#include <cstdint>
#include <vector>

namespace reeb {

/// Level n, 0 <= n < count, is float(origin + n * step), binary64, moved by as many binary32
/// numbers as `corrections` say: where rounding went another way, or text came in between.
struct FrameGrid {
  static constexpr uint32_t kMaxCount = 0xFFFF;
  struct Correction {
    uint32_t level;
    int32_t places;  ///< not 0
    bool operator==(const Correction&) const = default;
  };
  uint32_t count = 0;                   ///< 0: the frame has no grid
  double origin = 0;                    ///< at most the largest binary32
  double step = 1;                      ///< positive, at most the largest binary32
  std::vector<Correction> corrections;  ///< levels rise

  bool operator==(const FrameGrid&) const = default;
};

}  // namespace reeb
