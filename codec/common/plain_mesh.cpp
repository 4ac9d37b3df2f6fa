#include "codec/common/plain_mesh.h"

#include <algorithm>

namespace reeb {

std::vector<float> position_weights(const PredictionGraph& graph) {
  constexpr float kBeyond = 0.125f;
  constexpr uint32_t kLeastBeyond = 4;
  std::vector<float> out(size_t{graph.size()} * kMaxNeighbours);
  for (uint32_t r = 0; r < graph.size(); ++r) {
    const PredictionGraph::Row& row = graph.rows[r];
    float* w = &out[size_t{r} * kMaxNeighbours];
    const uint32_t beyond = row.count - row.ring;
    const float share = row.ring > 2 && beyond >= kLeastBeyond ? kBeyond : 0.0f;
    std::fill_n(w, row.ring, (1.0f + share) / static_cast<float>(std::max<uint32_t>(1, row.ring)));
    if (share > 0) std::fill_n(w + row.ring, beyond, -share / static_cast<float>(beyond));
  }
  return out;
}

}  // namespace reeb
