#include "codec/common/reference/loose_predictor.h"

#include <cstdlib>

namespace reeb {

void LoosePredictor::guess(size_t axis, GuessMixture& out) const {
  out.clear();
  const auto& x = past_[axis];
  const int32_t places[3] = {x[0], 2 * x[0] - x[1], x[1]};
  const uint32_t scale = 128 + 8 * static_cast<uint32_t>(step_[axis]);
  for (uint32_t k = 0; k < 3; ++k) {
    out.add(static_cast<uint32_t>(axis) * 3 + k, (int64_t{places[k]} << 8) + 128, scale);
  }
}

void LoosePredictor::learn(size_t axis, int32_t value) {
  auto& x = past_[axis];
  step_[axis] += std::abs(value - x[0]) - step_[axis] / 16;
  for (size_t i = kPast; i-- > 1;) x[i] = x[i - 1];
  x[0] = value;
}

}  // namespace reeb
