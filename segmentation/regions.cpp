#include "segmentation/regions.h"

#include <algorithm>
#include <map>
#include <utility>

#include "segmentation/union_find.h"

namespace reeb::segmentation {

void grow_regions(const Surface& surface, std::vector<uint32_t>& labels) {
  std::vector<uint32_t> front;
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != kNone) front.push_back(v);
  }
  for (size_t i = 0; i < front.size(); ++i) {
    for (const uint32_t e : surface.vertex_edges[front[i]]) {
      const uint32_t w = surface.opposite(e, front[i]);
      if (labels[w] != kNone) continue;
      labels[w] = labels[front[i]];
      front.push_back(w);
    }
  }
}

void keep_connected(const Surface& surface, std::vector<uint32_t>& labels, uint32_t region_count) {
  UnionFind parts(surface.vertex_count());
  for (const auto [a, b] : surface.edges) {
    if (labels[a] == labels[b]) parts.unite(a, b);
  }
  std::vector<uint32_t> size(labels.size(), 0);
  for (uint32_t v = 0; v < labels.size(); ++v) ++size[parts.find(v)];
  std::vector<uint32_t> largest(region_count, kNone);
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] == kNone) continue;
    const uint32_t part = parts.find(v);
    uint32_t& best = largest[labels[v]];
    if (best == kNone || size[part] > size[best]) best = part;
  }
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != kNone && parts.find(v) != largest[labels[v]]) labels[v] = kNone;
  }
  grow_regions(surface, labels);
}

uint32_t renumber(std::vector<uint32_t>& labels) {
  std::map<uint32_t, uint32_t> index;
  for (uint32_t& label : labels) {
    label = index.try_emplace(label, static_cast<uint32_t>(index.size())).first->second;
  }
  return static_cast<uint32_t>(index.size());
}

void add_region_areas(const Surface& surface, const std::vector<uint32_t>& labels,
                      std::vector<double>& areas) {
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const double third = triangle_area(surface, t) / 3;
    for (const uint32_t v : surface.triangles[t]) areas[labels[v]] += third;
  }
}

std::vector<RegionLink> border_links(const Surface& surface, const std::vector<uint32_t>& labels) {
  std::map<std::pair<uint32_t, uint32_t>, double> borders;
  for (const Triple& t : surface.triangles) {
    const Point centre = (surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3;
    const bool three = labels[t[0]] != labels[t[1]] && labels[t[1]] != labels[t[2]] &&
                       labels[t[2]] != labels[t[0]];
    for (int i = 0; i < 3; ++i) {
      const uint32_t u = t[i], v = t[(i + 1) % 3], w = t[(i + 2) % 3];
      if (labels[u] == labels[v]) continue;
      // Of two edges that lead from one region to another each carries half of the segment between
      // them.
      const double length =
          three
              ? ((surface.points[u] + surface.points[v]) / 2 - centre).norm()
              : 0.25 * (surface.points[w] - surface.points[labels[w] == labels[u] ? u : v]).norm();
      const auto [low, high] = std::minmax(labels[u], labels[v]);
      borders[{low, high}] += length;
    }
  }
  std::vector<RegionLink> links;
  for (const auto& [pair, length] : borders) links.push_back({pair.first, pair.second, length, 0});
  return links;
}

}  // namespace reeb::segmentation
