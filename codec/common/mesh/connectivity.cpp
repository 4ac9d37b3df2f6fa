#include "codec/common/mesh/connectivity.h"

#include <algorithm>

namespace reeb {
namespace {

// Boundary of the polygon that holds `start`, an unmarked half-edge. Every triangle adds one
// corner, so a boundary longer than `limit` means a marked cycle.
bool walk_boundary(uint32_t start, std::span<const uint32_t> triangles,
                   std::span<const uint32_t> twins, std::span<const uint8_t> diagonal,
                   std::vector<uint8_t>& walked, Polygons& out) {
  uint32_t size = 0;
  uint32_t h = start;
  do {
    if (walked[h] != 0) return false;
    walked[h] = 1;
    out.corners.push_back(triangles[h]);
    ++size;
    h = next_half_edge(h);
    while (diagonal[h] != 0) {
      if (walked[h] != 0) return false;
      walked[h] = 1;
      h = next_half_edge(twins[h]);
    }
  } while (h != start);
  out.sizes.push_back(size);
  return true;
}

}  // namespace

// Every edge is looked at from its lower vertex, around which the fan has all its half-edges.
std::vector<uint32_t> pair_half_edges(std::span<const uint32_t> triangles,
                                      const HalfEdgeFans& fans) {
  struct Edge {
    uint32_t low = UINT32_MAX;
    uint32_t half_edges;  // that are met
    uint32_t first;       // of them
  };
  std::vector<Edge> edge_to(fans.vertex_count());  // by the higher vertex, of the lower one at hand
  std::vector<uint32_t> twins(triangles.size(), kNoTwin);
  for (uint32_t v = 0; v < fans.vertex_count(); ++v) {
    const auto meet = [&](uint32_t high, uint32_t h) {
      if (high <= v) return;
      Edge& edge = edge_to[high];
      if (edge.low != v) {
        edge = {v, 1, h};
      } else if (++edge.half_edges == 2 && triangles[h] != triangles[edge.first]) {
        twins[h] = edge.first;
        twins[edge.first] = h;
      } else if (edge.half_edges == 3 && twins[edge.first] != kNoTwin) {
        twins[twins[edge.first]] = kNoTwin;
        twins[edge.first] = kNoTwin;
      }
    };
    for (const uint32_t h : fans[v]) {
      const uint32_t next = next_half_edge(h);
      const uint32_t before = next_half_edge(next);
      meet(triangles[next], h);
      meet(triangles[before], before);
    }
  }
  return twins;
}

std::vector<uint32_t> pair_half_edges(std::span<const uint32_t> triangles) {
  const auto highest = std::max_element(triangles.begin(), triangles.end());
  return pair_half_edges(triangles, HalfEdgeFans(triangles.empty() ? 0 : *highest + 1, triangles));
}

bool join_triangles(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
                    std::span<const uint8_t> diagonal, Polygons& out) {
  std::vector<uint8_t> walked(triangles.size(), 0);
  for (uint32_t t = 0; t < triangles.size() / 3; ++t) {
    for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (diagonal[h] != 0 || walked[h] != 0) continue;
      if (!walk_boundary(h, triangles, twins, diagonal, walked, out)) return false;
    }
  }
  // A polygon of k triangles has k + 2 corners; more faces mean rings, an unwalked half-edge means
  // a closed surface of diagonals.
  return out.corners.size() == triangles.size() / 3 + 2 * out.sizes.size() &&
         std::find(walked.begin(), walked.end(), 0) == walked.end();
}

}  // namespace reeb
