#include "segmentation/segmentation.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>
#include <utility>

#include "segmentation/own_unit.h"
#include "segmentation/piece.h"
#include "segmentation/regions.h"
#include "segmentation/surface.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

// Pieces with a smaller part of all vertices are one region each: with the cap it bounds the number
// of spectra.
constexpr double kMinPiecePart = 0.002;

Options checked(Options o) {
  o.eigenpairs = std::clamp(o.eigenpairs, 2u, 1000u);
  const auto limit = [](double value, double low, double high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : low;
  };
  o.diffusion_time = limit(o.diffusion_time, 0.001, 10);
  o.feature_persistence = limit(o.feature_persistence, 0, 1);
  o.feature_radius = limit(o.feature_radius, 0, 1);
  o.graph_persistence = limit(o.graph_persistence, 0, 1);
  o.border_window = limit(o.border_window, 0, 1);
  o.min_body = limit(o.min_body, 0, 1);
  o.min_piece_vertices = std::clamp(o.min_piece_vertices, 4u, 1000000u);
  o.max_regions = std::clamp(o.max_regions, 1u, 4096u);
  return o;
}

class Segmenter {
 public:
  Segmenter(std::span<const float> positions, std::span<const uint32_t> triangles,
            const Options& options)
      : options_(options),
        positions_(positions),
        pieces_(split_pieces(positions, triangles, options.weld)) {
    result_.labels.assign(positions.size() / 3, kNone);
    result_.scalar.assign(positions.size() / 3, 0.0);
  }

  Result run() {
    if (pieces_.ignored_triangles > 0) {
      warn(std::to_string(pieces_.ignored_triangles) + " unusable triangles were ignored");
    }
    for (const uint32_t piece : by_size()) segment_piece(piece);
    label_rest();
    finish();
    return std::move(result_);
  }

 private:
  void warn(std::string text) { result_.warnings.push_back(std::move(text)); }

  std::vector<uint32_t> by_size() const {
    std::vector<uint32_t> order(pieces_.surfaces.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return pieces_.surfaces[a].vertex_count() > pieces_.surfaces[b].vertex_count();
    });
    return order;
  }

  void segment_piece(uint32_t piece) {
    const Surface& surface = pieces_.surfaces[piece];
    if (result_.region_count >= options_.max_regions) return;
    PieceResult part;
    const bool large = surface.vertex_count() >= options_.min_piece_vertices &&
                       surface.vertex_count() >= kMinPiecePart * static_cast<double>(size());
    if (!large || !analysed(surface, part) ||
        result_.region_count + part.region_count > options_.max_regions) {
      part = single_region(surface);
    }
    append(piece, part);
  }

  size_t size() const { return result_.labels.size(); }

  bool analysed(const Surface& surface, PieceResult& part) {
    try {
      if (analyse(surface, options_, part)) return true;
    } catch (const std::exception&) {
      // The eigensolver reports numerical trouble so; the piece stays one region.
    }
    warn("no diffusion function on a piece of " + std::to_string(surface.vertex_count()) +
         " vertices; it is one region");
    return false;
  }

  void append(uint32_t piece, const PieceResult& part) {
    const auto& original = pieces_.original[piece];
    const uint32_t first_node = static_cast<uint32_t>(result_.graph.nodes.size());
    const uint32_t first_region = result_.region_count;
    for (uint32_t n = 0; n < part.graph.nodes.size(); ++n) {
      const ReebNode& node = part.graph.nodes[n];
      const uint32_t body = part.node_region[n];
      result_.graph.nodes.push_back({original[node.vertex], node.value, node.type,
                                     result_.graph.component_count,
                                     body == kNone ? kNoRegion : first_region + body});
    }
    ++result_.graph.component_count;
    for (uint32_t a = 0; a < part.graph.arcs.size(); ++a) {
      const auto& arc = part.graph.arcs[a];
      result_.graph.arcs.push_back({first_node + arc.from, first_node + arc.to, first_region + a});
    }
    for (uint32_t v = 0; v < original.size(); ++v) {
      result_.labels[original[v]] = first_region + part.labels[v];
      result_.scalar[original[v]] = part.scalar[v];
    }
    for (const uint32_t v : part.features) result_.feature_points.push_back(original[v]);
    result_.region_count += part.region_count;
    segmented_.push_back(piece);
  }

  // Welded doubles take over their vertex; pieces beyond the limit and vertices without a triangle
  // take the region of the nearest vertex that has one.
  void label_rest() {
    for (uint32_t v = 0; v < size(); ++v) {
      const uint32_t piece = pieces_.piece[v];
      if (piece == kNone) continue;
      const uint32_t low = pieces_.original[piece][pieces_.local[v]];
      result_.labels[v] = result_.labels[low];
      result_.scalar[v] = result_.scalar[low];
    }
    if (result_.region_count == 0) return label_all();
    const uint32_t rest = label_by_nearest(positions_, result_.labels, result_.scalar);
    if (rest > 0) {
      warn(std::to_string(rest) + " vertices of no segmented piece took the nearest region");
    }
  }

  void label_all() {
    if (size() == 0) return;
    warn("no usable triangle; all vertices are one region");
    std::fill(result_.labels.begin(), result_.labels.end(), 0u);
    result_.region_count = 1;
  }

  void finish() {
    std::sort(result_.feature_points.begin(), result_.feature_points.end());
    drop_empty_regions();
    result_.region_areas.assign(result_.region_count, 0.0);
    for (const uint32_t piece : segmented_) {
      const std::vector<uint32_t> labels = labels_of(piece);
      add_region_areas(pieces_.surfaces[piece], labels, result_.region_areas);
      const auto links = border_links(pieces_.surfaces[piece], labels);
      result_.links.insert(result_.links.end(), links.begin(), links.end());
    }
    const auto gaps = gap_links(positions_, result_.labels, result_.links);
    result_.links.insert(result_.links.end(), gaps.begin(), gaps.end());
  }

  std::vector<uint32_t> labels_of(uint32_t piece) const {
    std::vector<uint32_t> labels;
    for (const uint32_t v : pieces_.original[piece]) labels.push_back(result_.labels[v]);
    return labels;
  }

  // An arc too short to hold a vertex shares the region of one of its ends.
  void drop_empty_regions() {
    std::vector<uint32_t> index(result_.region_count, kNone);
    for (const uint32_t label : result_.labels) index[label] = 0;
    uint32_t count = 0;
    for (uint32_t& i : index) i = i == kNone ? kNone : count++;
    for (uint32_t& label : result_.labels) label = index[label];
    for (Arc& arc : result_.graph.arcs) {
      arc.region = index[arc.region];
      if (arc.region == kNone) arc.region = result_.labels[result_.graph.nodes[arc.from].vertex];
    }
    for (Node& node : result_.graph.nodes) {
      if (node.region != kNoRegion) node.region = index[node.region];
    }
    result_.region_count = count;
  }

  const Options options_;
  std::span<const float> positions_;
  Pieces pieces_;
  std::vector<uint32_t> segmented_;  // pieces with regions of their own
  Result result_;
};

}  // namespace

uint32_t Graph::loops() const {
  UnionFind sets(static_cast<uint32_t>(nodes.size()));
  uint32_t loops = 0;
  for (const Arc& arc : arcs) loops += !sets.unite(arc.from, arc.to);
  return loops;
}

Result segment(std::span<const float> positions, std::span<const uint32_t> triangles,
               const Options& options) {
  const OwnUnit own = in_own_unit(positions);
  Result result = Segmenter(own.positions, triangles, checked(options)).run();
  for (RegionLink& link : result.links) {
    link.border *= own.unit;
    link.gap *= own.unit;
  }
  for (double& area : result.region_areas) area *= own.unit * own.unit;
  return result;
}

}  // namespace reeb::segmentation
