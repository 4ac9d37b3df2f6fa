#include "codec/common/plain_mesh.h"

#include <algorithm>

namespace reeb {

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
