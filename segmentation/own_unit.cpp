#include "segmentation/own_unit.h"

#include <algorithm>
#include <cmath>

namespace reeb::segmentation {

OwnUnit in_own_unit(std::span<const float> positions) {
  float largest = 0;
  for (const float x : positions) {
    if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
  }
  OwnUnit out;
  out.positions.assign(positions.begin(), positions.end());
  if (largest == 0) return out;
  const int exponent = std::ilogb(largest);
  out.unit = std::ldexp(1.0, exponent);
  for (float& x : out.positions) x = std::ldexp(x, -exponent);
  return out;
}

}  // namespace reeb::segmentation
