#include "segmentation/piece.h"

#include <algorithm>
#include <cmath>

#include "segmentation/curvature.h"
#include "segmentation/diffusion.h"
#include "segmentation/feature_points.h"
#include "segmentation/reeb_graph.h"
#include "segmentation/region_cut.h"

namespace reeb::segmentation {
namespace {

// Averages the curvature over a few rings, so that it shows joints and not the noise of a capture.
constexpr int kCurvatureRounds = 4;

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
  result.graph.arcs = {{0, 1, 0, 0, 0}};
  result.node_region.assign(2, kNone);
  return result;
}

bool analyse(const Surface& surface, const Options& options, PieceResult& result) {
  const double area = total_area(surface);
  if (!(area > 0) || !std::isfinite(area)) return false;
  const Laplacian laplacian = build_laplacian(surface);
  return analyse(surface, laplacian, smallest_eigenpairs(laplacian, options.eigenpairs), options,
                 result);
}

bool analyse(const Surface& surface, const Laplacian& laplacian, const Eigenpairs& pairs,
             const Options& options, PieceResult& result) {
  if (pairs.values.size() < 2 || !pairs.vectors.allFinite() || !(pairs.values[1] > 0)) return false;
  const Eigen::MatrixXd embedding =
      diffusion_embedding(pairs, options.diffusion_time / pairs.values[1]);
  result.features = feature_points(surface, embedding, options.feature_persistence,
                                   options.feature_radius * std::sqrt(total_area(surface)));
  const Eigen::VectorXd f = distance_function(embedding, result.features);
  result.scalar.assign(f.begin(), f.end());
  const ReebGraph sweep = sweep_reeb_graph(surface, result.scalar);
  std::vector<bool> keep;
  for (const ReebNode& node : sweep.nodes) {
    keep.push_back(std::binary_search(result.features.begin(), result.features.end(), node.vertex));
  }
  result.graph = simplify(sweep, keep, options.graph_persistence);
  const Eigen::VectorXd curvature = minimal_curvature(surface, laplacian, kCurvatureRounds);
  RegionCut cut = cut_regions(surface, result.scalar, sweep, result.graph, curvature,
                              {options.border_window, options.min_body});
  result.labels = std::move(cut.labels);
  result.region_count = cut.region_count;
  result.node_region = std::move(cut.node_region);
  return true;
}

}  // namespace reeb::segmentation
