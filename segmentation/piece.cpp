#include "segmentation/piece.h"

#include <algorithm>
#include <cmath>

#include "segmentation/diffusion.h"
#include "segmentation/feature_points.h"
#include "segmentation/reeb_graph.h"
#include "segmentation/regions.h"

namespace reeb::segmentation {
namespace {

// Regions of the arcs; an arc too short to have a vertex of its own shares that of its first node.
void label_by_arcs(const Surface& surface, const ReebGraph& sweep, PieceResult& result) {
  const uint32_t arc_count = static_cast<uint32_t>(result.graph.arcs.size());
  result.labels.resize(surface.vertex_count());
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) {
    result.labels[v] = result.graph.arc_of[sweep.vertex_arc[v]];
  }
  grow_regions(surface, result.labels);
  keep_connected(surface, result.labels, arc_count);
  result.region_count = arc_count;
}

}  // namespace

PieceResult single_region(const Surface& surface) {
  PieceResult result;
  result.labels.assign(surface.vertex_count(), 0);
  result.scalar.assign(surface.vertex_count(), 0);
  const auto farthest = [&](uint32_t from) {
    uint32_t best = from;
    for (uint32_t v = 0; v < surface.vertex_count(); ++v) {
      const Point& p = surface.points[from];
      if ((surface.points[v] - p).squaredNorm() > (surface.points[best] - p).squaredNorm())
        best = v;
    }
    return best;
  };
  const uint32_t start = farthest(0), end = farthest(start);
  result.graph.nodes = {{start, 0, NodeType::kMinimum}, {end, 0, NodeType::kMaximum}};
  result.graph.arcs = {{0, 1, 0}};
  return result;
}

bool analyse(const Surface& surface, const Options& options, PieceResult& result) {
  const double area = total_area(surface);
  if (!(area > 0) || !std::isfinite(area)) return false;
  const Eigenpairs pairs = smallest_eigenpairs(build_laplacian(surface), options.eigenpairs);
  if (pairs.values.size() < 2 || !pairs.vectors.allFinite() || !(pairs.values[1] > 0)) return false;
  const Eigen::MatrixXd embedding =
      diffusion_embedding(pairs, options.diffusion_time / pairs.values[1]);
  result.features = feature_points(surface, embedding, options.feature_persistence,
                                   options.feature_radius * std::sqrt(area));
  const Eigen::VectorXd f = distance_function(embedding, result.features);
  result.scalar.assign(f.begin(), f.end());
  const ReebGraph sweep = sweep_reeb_graph(surface, result.scalar);
  std::vector<bool> keep;
  for (const ReebNode& node : sweep.nodes) {
    keep.push_back(std::binary_search(result.features.begin(), result.features.end(), node.vertex));
  }
  result.graph = simplify(sweep, keep, options.graph_persistence);
  label_by_arcs(surface, sweep, result);
  return true;
}

}  // namespace reeb::segmentation
