#include "codec/common/lossless/surface_start.h"

#include <algorithm>
#include <limits>

namespace reeb {

std::vector<float> start_positions(const GridPoints& points, const std::vector<uint32_t>& order,
                                   const float origin[3], float step) {
  constexpr double kMaxFloat = std::numeric_limits<float>::max();
  std::vector<float> out;
  out.reserve(3 * order.size());
  for (const uint32_t v : order) {
    for (int a = 0; a < 3; ++a) {
      const double x = static_cast<double>(origin[a]) + points[v][a] * static_cast<double>(step);
      out.push_back(static_cast<float>(std::clamp(x, -kMaxFloat, kMaxFloat)));
    }
  }
  return out;
}

}  // namespace reeb
