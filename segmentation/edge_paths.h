// Shortest paths along the edges of a surface.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Length of the shortest path from the nearest of `sources` to each vertex, over vertices w for
/// which `allowed(w, length)` holds; infinite where there is none. Units of the input.
template <class Allowed>
std::vector<double> edge_paths(const Surface& surface, std::span<const uint32_t> sources,
                               Allowed allowed) {
  std::vector<double> distance(surface.vertex_count(), std::numeric_limits<double>::infinity());
  using Item = std::pair<double, uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (const uint32_t v : sources) {
    distance[v] = 0;
    queue.push({0.0, v});
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    for (const uint32_t e : surface.vertex_edges[v]) {
      const uint32_t w = surface.opposite(e, v);
      const double through = d + surface.edge_length(e);
      if (!allowed(w, through) || through >= distance[w]) continue;
      distance[w] = through;
      queue.push({through, w});
    }
  }
  return distance;
}

}  // namespace reeb::segmentation
