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

std::vector<uint32_t> find_leaders(uint32_t vertex_count, std::span<const uint32_t> triangles) {
  constexpr uint32_t kNone = 0;  // at least 1 is added to those that are there
  std::vector<uint32_t> out(vertex_count, kNone);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (size_t j = 0; j < 3; ++j) {
      const auto [low, high] = std::minmax(triangles[i + j], triangles[i + (j + 1) % 3]);
      out[high] = std::max(out[high], low + 1);
    }
  }
  for (uint32_t v = 1; v < vertex_count; ++v) out[v] = out[v] == kNone ? v - 1 : out[v] - 1;
  return out;
}

}  // namespace reeb
