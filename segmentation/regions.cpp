#include "segmentation/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "segmentation/nearest.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

Point point_at(std::span<const float> positions, uint32_t v) {
  return {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
}

std::vector<Point> centroids(std::span<const float> positions, const std::vector<uint32_t>& labels,
                             uint32_t count) {
  std::vector<Point> sum(count, Point::Zero());
  std::vector<double> members(count, 0.0);
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (!finite_at(positions, v)) continue;
    sum[labels[v]] += point_at(positions, v);
    ++members[labels[v]];
  }
  for (uint32_t r = 0; r < count; ++r) sum[r] /= std::max(members[r], 1.0);
  return sum;
}

}  // namespace

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
  links.reserve(borders.size());
  for (const auto& [pair, length] : borders) links.push_back({pair.first, pair.second, length, 0});
  return links;
}

std::vector<RegionLink> gap_links(std::span<const float> positions,
                                  const std::vector<uint32_t>& labels,
                                  const std::vector<RegionLink>& links) {
  const uint32_t count = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  const std::vector<Point> centre = centroids(positions, labels, count);
  UnionFind joined(count);
  for (const RegionLink& link : links) joined.unite(link.a, link.b);
  // Prim's algorithm; between regions that are joined already the way is free.
  std::vector<double> gap(count, std::numeric_limits<double>::infinity());
  std::vector<uint32_t> from(count, 0);
  std::vector<bool> done(count, false);
  std::vector<RegionLink> gaps;
  uint32_t next = 0;
  for (uint32_t step = 0; step < count; ++step) {
    done[next] = true;
    if (step > 0 && joined.unite(from[next], next)) {
      const auto [a, b] = std::minmax(from[next], next);
      gaps.push_back({a, b, 0, gap[next]});
    }
    uint32_t nearest = kNone;
    for (uint32_t r = 0; r < count; ++r) {
      if (done[r]) continue;
      const double d = joined.find(r) == joined.find(next) ? 0 : (centre[r] - centre[next]).norm();
      if (d < gap[r]) {
        gap[r] = d;
        from[r] = next;
      }
      if (nearest == kNone || gap[r] < gap[nearest]) nearest = r;
    }
    next = nearest;
  }
  return gaps;
}

uint32_t label_by_nearest(std::span<const float> positions, std::vector<uint32_t>& labels,
                          std::vector<double>& values) {
  std::vector<uint32_t> labelled;
  std::vector<Point> points;
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] == kNone) continue;
    labelled.push_back(v);
    points.push_back(point_at(positions, v));
  }
  const uint32_t rest = static_cast<uint32_t>(labels.size() - labelled.size());
  if (rest == 0) return 0;
  const NearestPoint nearest(std::move(points));
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != kNone) continue;
    const bool finite = finite_at(positions, v);
    const uint32_t source = labelled[finite ? nearest.find(point_at(positions, v)) : 0];
    labels[v] = labels[source];
    values[v] = values[source];
  }
  return rest;
}

}  // namespace reeb::segmentation
