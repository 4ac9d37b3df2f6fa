#include "segmentation/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "segmentation/edge_paths.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

// Vertices on an edge of a single triangle: only there can a seam have cut the surface.
std::vector<bool> boundary_vertices(std::span<const Triple> triangles, size_t vertices) {
  std::vector<std::pair<uint32_t, uint32_t>> sides;
  for (const Triple& t : triangles) {
    for (int i = 0; i < 3; ++i) sides.push_back(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::sort(sides.begin(), sides.end());
  std::vector<bool> boundary(vertices, false);
  for (size_t i = 0; i < sides.size(); ++i) {
    const bool like_last = i > 0 && sides[i] == sides[i - 1];
    const bool like_next = i + 1 < sides.size() && sides[i] == sides[i + 1];
    if (!like_last && !like_next) boundary[sides[i].first] = boundary[sides[i].second] = true;
  }
  return boundary;
}

// The lowest of the eligible vertices at the same position; itself for all others.
std::vector<uint32_t> representatives(std::span<const float> positions,
                                      const std::vector<bool>& eligible) {
  std::vector<uint32_t> lowest(positions.size() / 3), order;
  std::iota(lowest.begin(), lowest.end(), 0u);
  for (uint32_t v = 0; v < lowest.size(); ++v) {
    if (eligible[v]) order.push_back(v);
  }
  const auto key = [&](uint32_t v) {
    return std::array{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) lowest[order[i]] = lowest[order[i - 1]];
  }
  return lowest;
}

bool usable(std::span<const float> positions, const Triple& t) {
  const uint32_t count = static_cast<uint32_t>(positions.size() / 3);
  for (const uint32_t v : t) {
    if (v >= count || !finite_at(positions, v)) return false;
  }
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

std::vector<Triple> usable_triangles(std::span<const float> positions,
                                     std::span<const uint32_t> triangles) {
  std::vector<Triple> kept;
  kept.reserve(triangles.size() / 3);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Triple t = {triangles[i], triangles[i + 1], triangles[i + 2]};
    if (usable(positions, t)) kept.push_back(t);
  }
  return kept;
}

void weld_triangles(std::vector<Triple>& triangles, std::span<const uint32_t> lowest) {
  for (Triple& t : triangles) {
    for (uint32_t& v : t) v = lowest[v];
  }
  std::erase_if(triangles,
                [](const Triple& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

void number_vertices(Pieces& pieces, std::span<const Triple> triangles,
                     std::span<const uint32_t> lowest) {
  const uint32_t count = static_cast<uint32_t>(lowest.size());
  UnionFind sets(count);
  std::vector<bool> used(count, false);
  for (const Triple& t : triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
    for (const uint32_t v : t) used[v] = true;
  }
  pieces.piece.assign(count, kNone);
  pieces.local.assign(count, kNone);
  std::vector<uint32_t> piece_of_root(count, kNone);
  for (uint32_t v = 0; v < count; ++v) {
    if (lowest[v] != v) {  // a welded double; its lowest vertex was numbered before
      pieces.piece[v] = pieces.piece[lowest[v]];
      pieces.local[v] = pieces.local[lowest[v]];
    } else if (used[v]) {
      uint32_t& piece = piece_of_root[sets.find(v)];
      if (piece == kNone) {
        piece = static_cast<uint32_t>(pieces.original.size());
        pieces.original.emplace_back();
      }
      pieces.piece[v] = piece;
      pieces.local[v] = static_cast<uint32_t>(pieces.original[piece].size());
      pieces.original[piece].push_back(v);
    }
  }
}

std::vector<Edge> unique_edges(std::span<const Triple> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triple& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      edges.push_back({low, high});
    }
  }
  const auto key = [](const Edge& e) { return std::pair(e.a, e.b); };
  std::sort(edges.begin(), edges.end(),
            [&](const Edge& x, const Edge& y) { return key(x) < key(y); });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [&](const Edge& x, const Edge& y) { return key(x) == key(y); }),
              edges.end());
  return edges;
}

uint32_t edge_index(const std::vector<Edge>& edges, uint32_t u, uint32_t v) {
  const auto [low, high] = std::minmax(u, v);
  const auto at = std::lower_bound(edges.begin(), edges.end(), std::pair(low, high),
                                   [](const Edge& e, const std::pair<uint32_t, uint32_t>& key) {
                                     return std::pair(e.a, e.b) < key;
                                   });
  return static_cast<uint32_t>(at - edges.begin());
}

// Row of each value in `members`, whose elements are groups of indices: item i appears in the row
// of each of its members.
template <typename Group>
Rows invert(std::span<const Group> groups, uint32_t rows) {
  Rows result;
  result.start.assign(rows + 1, 0);
  for (const Group& group : groups) {
    for (const uint32_t r : group) ++result.start[r + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.items.resize(result.start.back());
  std::vector<uint32_t> next(result.start.begin(), result.start.end() - 1);
  for (uint32_t i = 0; i < groups.size(); ++i) {
    for (const uint32_t r : groups[i]) result.items[next[r]++] = i;
  }
  return result;
}

}  // namespace

bool finite_at(std::span<const float> positions, uint32_t v) {
  return std::isfinite(positions[3 * v]) && std::isfinite(positions[3 * v + 1]) &&
         std::isfinite(positions[3 * v + 2]);
}

Rows group_by(std::span<const uint32_t> owner, uint32_t rows) {
  Rows result;
  result.start.assign(rows + 1, 0);
  for (const uint32_t r : owner) {
    if (r != kNone) ++result.start[r + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.items.resize(result.start.back());
  std::vector<uint32_t> next(result.start.begin(), result.start.end() - 1);
  for (uint32_t i = 0; i < owner.size(); ++i) {
    if (owner[i] != kNone) result.items[next[owner[i]]++] = i;
  }
  return result;
}

void connect(Surface& surface) {
  surface.edges = unique_edges(surface.triangles);
  surface.triangle_edges.clear();
  for (const Triple& t : surface.triangles) {
    surface.triangle_edges.push_back({edge_index(surface.edges, t[0], t[1]),
                                      edge_index(surface.edges, t[1], t[2]),
                                      edge_index(surface.edges, t[2], t[0])});
  }
  std::vector<std::array<uint32_t, 2>> ends;
  for (const Edge& e : surface.edges) ends.push_back({e.a, e.b});
  const uint32_t edge_count = static_cast<uint32_t>(surface.edges.size());
  surface.vertex_edges =
      invert(std::span<const std::array<uint32_t, 2>>(ends), surface.vertex_count());
  surface.vertex_triangles =
      invert(std::span<const Triple>(surface.triangles), surface.vertex_count());
  surface.edge_triangles = invert(std::span<const Triple>(surface.triangle_edges), edge_count);
}

double triangle_area(const Surface& surface, uint32_t triangle) {
  const auto [a, b, c] = surface.triangles[triangle];
  const Point& p = surface.points[a];
  return 0.5 * (surface.points[b] - p).cross(surface.points[c] - p).norm();
}

double total_area(const Surface& surface) {
  double area = 0;
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) area += triangle_area(surface, t);
  return area;
}

std::vector<double> edge_distances(const Surface& surface, uint32_t source, double radius) {
  return edge_paths(surface, {&source, 1},
                    [radius](uint32_t, double length) { return length <= radius; });
}

Pieces split_pieces(std::span<const float> positions, std::span<const uint32_t> triangles,
                    bool weld) {
  Pieces pieces;
  std::vector<Triple> kept = usable_triangles(positions, triangles);
  const size_t vertices = positions.size() / 3;
  const std::vector<uint32_t> lowest = representatives(
      positions, weld ? boundary_vertices(kept, vertices) : std::vector<bool>(vertices, false));
  weld_triangles(kept, lowest);
  pieces.ignored_triangles = static_cast<uint32_t>(triangles.size() / 3 - kept.size());
  number_vertices(pieces, kept, lowest);
  pieces.surfaces.resize(pieces.original.size());
  for (size_t p = 0; p < pieces.surfaces.size(); ++p) {
    for (const uint32_t v : pieces.original[p]) {
      pieces.surfaces[p].points.emplace_back(positions[3 * v], positions[3 * v + 1],
                                             positions[3 * v + 2]);
    }
  }
  for (const Triple& t : kept) {
    pieces.surfaces[pieces.piece[t[0]]].triangles.push_back(
        {pieces.local[t[0]], pieces.local[t[1]], pieces.local[t[2]]});
  }
  for (Surface& surface : pieces.surfaces) connect(surface);
  return pieces;
}

}  // namespace reeb::segmentation
