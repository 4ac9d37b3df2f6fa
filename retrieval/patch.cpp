#include "retrieval/patch.h"

#include <algorithm>
#include <numeric>

#include "segmentation/edge_paths.h"
#include "segmentation/union_find.h"

namespace reeb::retrieval {
namespace {

using segmentation::UnionFind;

// Triangles of a surface and the edges at which they hang together.
class Gluer {
 public:
  Gluer(const Surface& surface, std::span<const uint32_t> triangles, const std::vector<bool>& cut)
      : surface_(surface), triangles_(triangles), corners_(3 * size()), sets_(size()) {
    std::vector<std::vector<uint32_t>> sides(surface.edges.size());
    for (uint32_t i = 0; i < size(); ++i) {
      for (const uint32_t e : surface.triangle_edges[triangles[i]]) sides[e].push_back(i);
    }
    for (uint32_t e = 0; e < sides.size(); ++e) {
      if (sides[e].size() == 2 && (cut.empty() || !cut[e])) join(sides[e][0], sides[e][1], e);
    }
  }

  std::vector<Patch> run() {
    std::vector<Patch> patches;
    std::vector<uint32_t> patch_of(size(), kNone);
    std::vector<uint32_t> vertex_of(3 * size_t{size()},
                                    kNone);  // per corner that stands for its set
    for (uint32_t i = 0; i < size(); ++i) {
      uint32_t& number = patch_of[sets_.find(i)];
      if (number == kNone) {
        number = static_cast<uint32_t>(patches.size());
        patches.emplace_back();
      }
      add(patches[number], i, vertex_of);
    }
    return patches;
  }

 private:
  uint32_t size() const { return static_cast<uint32_t>(triangles_.size()); }

  uint32_t corner(uint32_t i, uint32_t vertex) const {
    const Triple& t = surface_.triangles[triangles_[i]];
    return 3 * i + static_cast<uint32_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
  }

  void join(uint32_t i, uint32_t j, uint32_t edge) {
    sets_.unite(i, j);
    for (const uint32_t v : {surface_.edges[edge].a, surface_.edges[edge].b})
      corners_.unite(corner(i, v), corner(j, v));
  }

  void add(Patch& patch, uint32_t i, std::vector<uint32_t>& vertex_of) {
    Triple triangle;
    for (uint32_t k = 0; k < 3; ++k) {
      uint32_t& vertex = vertex_of[corners_.find(3 * i + k)];
      if (vertex == kNone) {
        vertex = patch.surface.vertex_count();
        patch.surface.points.push_back(surface_.points[surface_.triangles[triangles_[i]][k]]);
      }
      triangle[k] = vertex;
    }
    patch.surface.triangles.push_back(triangle);
    patch.original.push_back(triangles_[i]);
  }

  const Surface& surface_;
  std::span<const uint32_t> triangles_;
  UnionFind corners_;
  UnionFind sets_;  // of triangles
};

bool on_boundary(const Surface& surface, uint32_t edge) {
  return surface.edge_triangles[edge].size() == 1;
}

// Walks along the edges of one triangle; each vertex of a manifold's boundary has two of them.
std::vector<Loop> boundary_loops(const Surface& surface) {
  std::vector<bool> seen(surface.edges.size(), false);
  std::vector<Loop> loops;
  for (uint32_t start = 0; start < surface.edges.size(); ++start) {
    if (seen[start] || !on_boundary(surface, start)) continue;
    Loop& loop = loops.emplace_back();
    uint32_t vertex = surface.edges[start].a;
    for (uint32_t edge = start; edge != kNone;) {
      seen[edge] = true;
      loop.push_back(vertex);
      vertex = surface.opposite(edge, vertex);
      edge = kNone;
      for (const uint32_t e : surface.vertex_edges[vertex]) {
        if (!seen[e] && on_boundary(surface, e)) edge = e;
      }
    }
  }
  return loops;
}

// Fills what follows from the points and triangles.
void complete(Patch& patch) {
  connect(patch.surface);
  const Surface& s = patch.surface;
  patch.euler_characteristic = static_cast<int>(s.points.size()) -
                               static_cast<int>(s.edges.size()) +
                               static_cast<int>(s.triangles.size());
  patch.boundaries = boundary_loops(s);
  std::stable_sort(
      patch.boundaries.begin(), patch.boundaries.end(),
      [&](const Loop& a, const Loop& b) { return loop_length(s, a) > loop_length(s, b); });
  patch.area = 0;
  for (uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (patch.original[t] != kNone) patch.area += triangle_area(s, t);
  }
}

// Edges that a spanning tree of the triangles does not cross.
std::vector<bool> uncrossed_edges(const Surface& surface) {
  std::vector<bool> uncrossed(surface.edges.size(), true);
  std::vector<bool> reached(surface.triangles.size(), false);
  std::vector<uint32_t> queue{0};
  reached[0] = true;
  for (size_t next = 0; next < queue.size(); ++next) {
    for (const uint32_t e : surface.triangle_edges[queue[next]]) {
      for (const uint32_t t : surface.edge_triangles[e]) {
        if (reached[t]) continue;
        reached[t] = true;
        uncrossed[e] = false;
        queue.push_back(t);
      }
    }
  }
  return uncrossed;
}

// Takes edges with a loose end away until there are none.
void prune(const Surface& surface, std::vector<bool>& edges) {
  std::vector<uint32_t> degree(surface.vertex_count(), 0);
  for (uint32_t e = 0; e < edges.size(); ++e) {
    if (!edges[e]) continue;
    ++degree[surface.edges[e].a];
    ++degree[surface.edges[e].b];
  }
  for (uint32_t v = 0; v < degree.size(); ++v) {
    for (uint32_t end = v; degree[end] == 1;) {
      const auto around = surface.vertex_edges[end];
      const uint32_t e =
          *std::find_if(around.begin(), around.end(), [&](uint32_t i) { return edges[i]; });
      edges[e] = false;
      degree[end] = 0;
      end = surface.opposite(e, end);
      --degree[end];
    }
  }
}

std::vector<uint32_t> all_triangles(const Surface& surface) {
  std::vector<uint32_t> all(surface.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// From triangles of `patch` to those of the surface that it comes from.
void name_originals(const Patch& patch, std::vector<Patch>& parts) {
  for (Patch& part : parts) {
    for (uint32_t& t : part.original) t = patch.original[t];
    complete(part);
  }
}

}  // namespace

std::vector<Patch> glue(const Surface& surface, std::span<const uint32_t> triangles,
                        const std::vector<bool>& cut) {
  std::vector<Patch> patches = Gluer(surface, triangles, cut).run();
  for (Patch& patch : patches) complete(patch);
  return patches;
}

double loop_length(const Surface& surface, const Loop& loop) {
  double length = 0;
  for (size_t i = 0; i < loop.size(); ++i)
    length += (surface.points[loop[i]] - surface.points[loop[(i + 1) % loop.size()]]).norm();
  return length;
}

Patch cap_boundaries(const Patch& patch, size_t keep) {
  if (patch.boundaries.size() <= keep) return patch;
  Patch capped;
  capped.surface.points = patch.surface.points;
  capped.surface.triangles = patch.surface.triangles;
  capped.original = patch.original;
  for (size_t b = keep; b < patch.boundaries.size(); ++b) {
    const Loop& loop = patch.boundaries[b];
    Point middle = Point::Zero();
    for (const uint32_t v : loop)
      middle += patch.surface.points[v] / static_cast<double>(loop.size());
    const uint32_t hub = capped.surface.vertex_count();
    capped.surface.points.push_back(middle);
    for (size_t i = 0; i < loop.size(); ++i) {
      capped.surface.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], hub});
      capped.original.push_back(kNone);
    }
  }
  complete(capped);
  return capped;
}

Patch cut_to_disc(const Patch& patch) {
  std::vector<bool> cut = uncrossed_edges(patch.surface);
  prune(patch.surface, cut);
  std::vector<Patch> parts = Gluer(patch.surface, all_triangles(patch.surface), cut).run();
  name_originals(patch, parts);
  return std::move(parts.front());
}

std::vector<Patch> halve(const Patch& patch) {
  const Surface& surface = patch.surface;
  const auto farthest = [](const std::vector<double>& distance) {
    return static_cast<uint32_t>(std::max_element(distance.begin(), distance.end()) -
                                 distance.begin());
  };
  const uint32_t a = farthest(edge_distances(surface, 0, HUGE_VAL));
  const std::vector<double> from_a = edge_distances(surface, a, HUGE_VAL);
  const std::vector<double> from_b = edge_distances(surface, farthest(from_a), HUGE_VAL);
  std::array<std::vector<uint32_t>, 2> halves;
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
    double difference = 0;
    for (const uint32_t v : surface.triangles[t]) difference += from_a[v] - from_b[v];
    halves[difference < 0 ? 0 : 1].push_back(t);
  }
  for (size_t h = 0; h < 2; ++h) {  // a surface so small that all is equally near
    if (!halves[h].empty()) continue;
    halves[h].push_back(halves[1 - h].back());
    halves[1 - h].pop_back();
  }
  std::vector<Patch> parts;
  for (const auto& half : halves) {
    for (Patch& part : Gluer(surface, half, {}).run()) parts.push_back(std::move(part));
  }
  name_originals(patch, parts);
  return parts;
}

}  // namespace reeb::retrieval
