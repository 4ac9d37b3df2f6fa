#include "segmentation/reeb_graph.h"

#include <algorithm>
#include <numeric>

namespace reeb::segmentation {
namespace {

class Sweep {
 public:
  Sweep(const Surface& surface, std::span<const double> f)
      : surface_(surface),
        f_(f),
        order_(surface.vertex_count()),
        rank_(surface.vertex_count()),
        edge_arc_(surface.edges.size(), kNone),
        visited_(surface.edges.size(), 0),
        link_set_(surface.vertex_count()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(),
              [&](uint32_t a, uint32_t b) { return f_[a] != f_[b] ? f_[a] < f_[b] : a < b; });
    for (uint32_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;
    graph_.vertex_arc.assign(order_.size(), kNone);
  }

  ReebGraph run() {
    for (const uint32_t v : order_) pass(v);
    return std::move(graph_);
  }

 private:
  bool above(uint32_t w, uint32_t v) const { return rank_[w] > rank_[v]; }

  // Connected components of the part of the link of v above or below it.
  uint32_t link_components(uint32_t v, bool upper) {
    uint32_t components = 0;
    for (const uint32_t e : surface_.vertex_edges[v]) {
      const uint32_t w = surface_.opposite(e, v);
      if (above(w, v) != upper) continue;
      link_set_[w] = w;
      ++components;
    }
    for (const uint32_t t : surface_.vertex_triangles[v]) {
      uint32_t sets[2] = {kNone, kNone};
      int found = 0;
      for (const uint32_t w : surface_.triangles[t]) {
        if (w != v && above(w, v) == upper) sets[found++] = link_set(w);
      }
      if (found == 2 && sets[0] != sets[1]) {
        link_set_[sets[1]] = sets[0];
        --components;
      }
    }
    return components;
  }

  uint32_t link_set(uint32_t w) {
    for (; link_set_[w] != w; w = link_set_[w]) link_set_[w] = link_set_[link_set_[w]];
    return w;
  }

  std::vector<uint32_t> arcs_below(uint32_t v) const {
    std::vector<uint32_t> arcs;
    for (const uint32_t e : surface_.vertex_edges[v]) {
      if (!above(surface_.opposite(e, v), v)) arcs.push_back(edge_arc_[e]);
    }
    std::sort(arcs.begin(), arcs.end());
    arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
    return arcs;
  }

  bool crosses(uint32_t e, uint32_t v) const {
    const auto [a, b] = surface_.edges[e];
    return (rank_[a] <= rank_[v]) != (rank_[b] <= rank_[v]);
  }

  // Edges of the level set component just above v that crosses `seed`.
  std::vector<uint32_t> contour(uint32_t seed, uint32_t v) {
    std::vector<uint32_t> edges = {seed};
    visited_[seed] = stamp_;
    for (size_t i = 0; i < edges.size(); ++i) {
      for (const uint32_t t : surface_.edge_triangles[edges[i]]) {
        for (const uint32_t e : surface_.triangle_edges[t]) {
          if (visited_[e] == stamp_ || !crosses(e, v)) continue;
          visited_[e] = stamp_;
          edges.push_back(e);
        }
      }
    }
    return edges;
  }

  std::vector<std::vector<uint32_t>> contours_above(uint32_t v) {
    ++stamp_;
    std::vector<std::vector<uint32_t>> contours;
    for (const uint32_t e : surface_.vertex_edges[v]) {
      if (above(surface_.opposite(e, v), v) && visited_[e] != stamp_) {
        contours.push_back(contour(e, v));
      }
    }
    return contours;
  }

  void continue_arc(uint32_t v, uint32_t arc) {
    graph_.vertex_arc[v] = arc;
    for (const uint32_t e : surface_.vertex_edges[v]) {
      if (above(surface_.opposite(e, v), v)) edge_arc_[e] = arc;
    }
  }

  void pass(uint32_t v) {
    const uint32_t lower = link_components(v, false);
    const uint32_t upper = link_components(v, true);
    const std::vector<uint32_t> ending = arcs_below(v);
    if (lower == 1 && upper == 1) return continue_arc(v, ending.front());
    const std::vector<std::vector<uint32_t>> contours = contours_above(v);
    // The link alone does not tell: both sides of a saddle may lie on one contour, before and
    // after.
    if (ending.size() == 1 && contours.size() == 1) return continue_arc(v, ending.front());
    const NodeType type = lower == 0   ? NodeType::kMinimum
                          : upper == 0 ? NodeType::kMaximum
                                       : NodeType::kSaddle;
    add_node(v, type, ending, contours);
  }

  void add_node(uint32_t v, NodeType type, const std::vector<uint32_t>& ending,
                const std::vector<std::vector<uint32_t>>& contours) {
    const uint32_t node = static_cast<uint32_t>(graph_.nodes.size());
    graph_.nodes.push_back({v, f_[v], type});
    for (const uint32_t arc : ending) graph_.arcs[arc].high = node;
    graph_.vertex_arc[v] = static_cast<uint32_t>(graph_.arcs.size());
    if (contours.empty()) graph_.vertex_arc[v] = ending.empty() ? kNone : ending.front();
    for (const auto& edges : contours) {
      for (const uint32_t e : edges) edge_arc_[e] = static_cast<uint32_t>(graph_.arcs.size());
      graph_.arcs.push_back({node, kNone});
    }
  }

  const Surface& surface_;
  std::span<const double> f_;
  std::vector<uint32_t> order_, rank_;
  std::vector<uint32_t> edge_arc_;  // arc of the contour that crosses the edge, once it was reached
  std::vector<uint32_t> visited_;
  uint32_t stamp_ = 0;
  std::vector<uint32_t>
      link_set_;  // of neighbours of the vertex that is passed, as they hang together
  ReebGraph graph_;
};

}  // namespace

ReebGraph sweep_reeb_graph(const Surface& surface, std::span<const double> f) {
  return Sweep(surface, f).run();
}

}  // namespace reeb::segmentation
