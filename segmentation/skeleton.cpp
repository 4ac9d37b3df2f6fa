#include "segmentation/skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "segmentation/edge_paths.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {
namespace {

// Bands of an arc's region across the way from one node to the other.
constexpr size_t kBands = 6;

// Area around each vertex, so that a dense side of a limb does not draw its middle over.
std::vector<double> vertex_areas(std::span<const float> positions,
                                 std::span<const uint32_t> triangles) {
  std::vector<double> areas(positions.size() / 3, 0.0);
  const Pieces pieces = split_pieces(positions, triangles, false);
  for (uint32_t p = 0; p < pieces.surfaces.size(); ++p) {
    const Surface& surface = pieces.surfaces[p];
    for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const double third = triangle_area(surface, t) / 3;
      for (const uint32_t v : surface.triangles[t]) areas[pieces.original[p][v]] += third;
    }
  }
  return areas;
}

Position mean_of(const std::vector<uint32_t>& vertices, std::span<const double> areas,
                 std::span<const float> frame) {
  double total = 0;
  for (const uint32_t v : vertices) total += areas[v];
  std::array<double, 3> sum = {};
  for (const size_t v : vertices) {
    const double weight = total > 0 ? areas[v] / total : 1 / static_cast<double>(vertices.size());
    for (size_t i = 0; i < 3; ++i) sum[i] += weight * frame[3 * v + i];
  }
  Position mean = {};
  for (size_t i = 0; i < 3; ++i) mean[i] = static_cast<float>(sum[i]);
  return mean;
}

// Finds the parts of the mesh that belong to nodes and arcs.
class Rigger {
 public:
  Rigger(const Result& segmentation, std::span<const float> positions,
         std::span<const uint32_t> triangles)
      : graph_(segmentation.graph),
        labels_(segmentation.labels),
        pieces_(split_pieces(positions, triangles, true)),
        regions_at_(graph_.nodes.size()) {
    for (const Arc& arc : graph_.arcs) {
      regions_at_[arc.from].push_back(arc.region);
      regions_at_[arc.to].push_back(arc.region);
    }
    for (uint32_t n = 0; n < regions_at_.size(); ++n) {
      if (graph_.nodes[n].region != kNoRegion) regions_at_[n].push_back(graph_.nodes[n].region);
    }
  }

  /// The middle of the borders of the regions that meet at a node; its own vertex where there is no
  /// border.
  std::vector<uint32_t> node_vertices(uint32_t node) const {
    std::vector<uint32_t> vertices;
    for (const uint32_t region : regions_at_[node]) {
      const auto border = border_vertices(region, node);
      vertices.insert(vertices.end(), border.begin(), border.end());
    }
    if (vertices.empty()) vertices.push_back(graph_.nodes[node].vertex);
    return vertices;
  }

  /// The region of an arc in bands from its first node to its second.
  std::vector<std::vector<uint32_t>> arc_bands(const Arc& arc) const {
    const auto from = distances(arc.region, arc.from), to = distances(arc.region, arc.to);
    std::vector<std::vector<uint32_t>> bands(kBands);
    const uint32_t piece = pieces_.piece[graph_.nodes[arc.from].vertex];
    for (uint32_t v = 0; piece != kNone && v < from.size(); ++v) {
      if (!std::isfinite(from[v]) || !std::isfinite(to[v])) continue;
      const double way = from[v] + to[v];
      const double share = way > 0 ? from[v] / way : 0.5;
      const size_t band = std::min(kBands - 1, static_cast<size_t>(share * kBands));
      bands[band].push_back(pieces_.original[piece][v]);
    }
    std::erase_if(bands, [](const auto& band) { return band.empty(); });
    return bands;
  }

 private:
  uint32_t piece_of(uint32_t node) const { return pieces_.piece[graph_.nodes[node].vertex]; }

  // Vertices of a region next to another region at the node.
  std::vector<uint32_t> border_vertices(uint32_t region, uint32_t node) const {
    const uint32_t piece = piece_of(node);
    if (piece == kNone) return {};
    const auto& around = regions_at_[node];
    std::vector<uint32_t> vertices;
    for (const auto [a, b] : pieces_.surfaces[piece].edges) {
      const uint32_t u = pieces_.original[piece][a], w = pieces_.original[piece][b];
      for (const auto& [inside, outside] : {std::pair(u, w), std::pair(w, u)}) {
        if (labels_[inside] != region || labels_[outside] == region) continue;
        if (std::count(around.begin(), around.end(), labels_[outside]) > 0) {
          vertices.push_back(inside);
        }
      }
    }
    return vertices;
  }

  // Distance along edges within a region from its end at `node`, per vertex of the piece.
  std::vector<double> distances(uint32_t region, uint32_t node) const {
    const uint32_t piece = piece_of(node);
    if (piece == kNone) return {};
    std::vector<uint32_t> sources = border_vertices(region, node);
    if (sources.empty()) sources.push_back(graph_.nodes[node].vertex);
    const Surface& surface = pieces_.surfaces[piece];
    for (uint32_t& v : sources) v = pieces_.local[v];
    return edge_paths(surface, sources, [&](uint32_t w, double) {
      return labels_[pieces_.original[piece][w]] == region;
    });
  }

  const Graph& graph_;
  const std::vector<uint32_t>& labels_;
  Pieces pieces_;
  std::vector<std::vector<uint32_t>> regions_at_;  // per node
};

}  // namespace

Skeleton::Skeleton(const Result& segmentation, std::span<const float> positions,
                   std::span<const uint32_t> triangles)
    : areas_(vertex_areas(positions, triangles)), regions_(segmentation.region_count) {
  for (uint32_t v = 0; v < segmentation.labels.size(); ++v) {
    regions_[segmentation.labels[v]].push_back(v);
  }
  const Rigger rigger(segmentation, positions, triangles);
  const Graph& graph = segmentation.graph;
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const uint32_t body = graph.nodes[n].region;
    nodes_.push_back(body != kNoRegion ? regions_[body] : rigger.node_vertices(n));
  }
  for (const Arc& arc : graph.arcs) arcs_.push_back(rigger.arc_bands(arc));
}

SkeletonPose Skeleton::place(std::span<const float> frame) const {
  SkeletonPose pose;
  for (const Vertices& node : nodes_) pose.nodes.push_back(mean_of(node, areas_, frame));
  for (const Vertices& region : regions_) pose.regions.push_back(mean_of(region, areas_, frame));
  for (const auto& bands : arcs_) {
    pose.arcs.emplace_back();
    for (const Vertices& band : bands) pose.arcs.back().push_back(mean_of(band, areas_, frame));
  }
  return pose;
}

}  // namespace reeb::segmentation
