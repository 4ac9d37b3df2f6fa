#include "codec/common/connectivity.h"

#include <algorithm>

namespace reeb {
namespace {

struct HalfEdgeKey {
  uint32_t low, high;  // vertices of the edge
  uint32_t half_edge;
  bool operator<(const HalfEdgeKey& o) const {
    return low != o.low ? low < o.low : high != o.high ? high < o.high : half_edge < o.half_edge;
  }
  bool same_edge(const HalfEdgeKey& o) const { return low == o.low && high == o.high; }
};

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

std::vector<uint32_t> pair_half_edges(std::span<const uint32_t> triangles) {
  std::vector<HalfEdgeKey> keys(triangles.size());
  for (uint32_t h = 0; h < keys.size(); ++h) {
    const uint32_t a = triangles[h];
    const uint32_t b = triangles[next_half_edge(h)];
    keys[h] = {std::min(a, b), std::max(a, b), h};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> twins(triangles.size(), kNoTwin);
  for (size_t i = 0, end; i < keys.size(); i = end) {
    for (end = i + 1; end < keys.size() && keys[end].same_edge(keys[i]);) ++end;
    if (end - i != 2) continue;
    const uint32_t h = keys[i].half_edge;
    const uint32_t k = keys[i + 1].half_edge;
    if (triangles[h] == triangles[k]) continue;
    twins[h] = k;
    twins[k] = h;
  }
  return twins;
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
