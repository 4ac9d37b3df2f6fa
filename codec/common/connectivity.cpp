#include "codec/common/connectivity.h"

#include <algorithm>

namespace reeb {
namespace {

struct EdgeEntry {
  uint32_t high;  // vertex of the edge; the bucket is the lower one
  uint32_t half_edge;
  bool operator<(const EdgeEntry& o) const {
    return high != o.high ? high < o.high : half_edge < o.half_edge;
  }
};

uint32_t end_of(std::span<const uint32_t> triangles, uint32_t h) {
  return triangles[next_half_edge(h)];
}

// Half-edges by the lower vertex of their edge, sorted within: `first` says where each vertex
// starts.
std::vector<EdgeEntry> sort_by_edge(std::span<const uint32_t> triangles,
                                    std::vector<uint32_t>& first) {
  const uint32_t vertex_count =
      triangles.empty() ? 0 : *std::max_element(triangles.begin(), triangles.end()) + 1;
  first.assign(size_t{vertex_count} + 1, 0);
  const auto low = [&](uint32_t h) { return std::min(triangles[h], end_of(triangles, h)); };
  for (uint32_t h = 0; h < triangles.size(); ++h) ++first[size_t{low(h)} + 1];
  for (size_t v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  std::vector<uint32_t> at(first.begin(), first.end() - 1);
  std::vector<EdgeEntry> entries(triangles.size());
  for (uint32_t h = 0; h < triangles.size(); ++h) {
    entries[at[low(h)]++] = {std::max(triangles[h], end_of(triangles, h)), h};
  }
  for (size_t v = 0; v < vertex_count; ++v) {
    std::sort(entries.begin() + first[v], entries.begin() + first[v + 1]);
  }
  return entries;
}

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
  std::vector<uint32_t> first;
  const std::vector<EdgeEntry> entries = sort_by_edge(triangles, first);
  std::vector<uint32_t> twins(triangles.size(), kNoTwin);
  for (size_t v = 0; v + 1 < first.size(); ++v) {
    for (size_t i = first[v], end; i < first[v + 1]; i = end) {
      for (end = i + 1; end < first[v + 1] && entries[end].high == entries[i].high;) ++end;
      if (end - i != 2) continue;
      const uint32_t h = entries[i].half_edge;
      const uint32_t k = entries[i + 1].half_edge;
      if (triangles[h] == triangles[k]) continue;
      twins[h] = k;
      twins[k] = h;
    }
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
