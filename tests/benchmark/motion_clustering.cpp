#include "tests/benchmark/motion_clustering.h"

#include <limits>

#include "segmentation/affine_fit.h"

namespace reeb::benchmark {
namespace {

using segmentation::AffineMap;
using segmentation::MotionSpace;

constexpr uint32_t kMaxFrames = 64;
constexpr int kMaxRounds = 100;

std::vector<uint32_t> voronoi_cells(const MotionSpace& space, uint32_t count, uint32_t seed) {
  const uint32_t vertices = static_cast<uint32_t>(space.corners.cols());
  std::vector<uint32_t> cell(vertices, 0);
  std::vector<double> distance(vertices, std::numeric_limits<double>::infinity());
  uint32_t centre = seed % vertices;
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t far = 0;
    for (uint32_t v = 0; v < vertices; ++v) {
      const double d = (space.corners.col(v) - space.corners.col(centre)).squaredNorm();
      if (d < distance[v]) {
        distance[v] = d;
        cell[v] = i;
      }
      if (distance[v] > distance[far]) far = v;
    }
    centre = far;
  }
  return cell;
}

bool reassign(const MotionSpace& space, const std::vector<AffineMap>& maps,
              std::vector<uint32_t>& labels) {
  bool changed = false;
  for (uint32_t v = 0; v < labels.size(); ++v) {
    uint32_t best = labels[v];
    double least = segmentation::squared_error(space, v, maps[best]);
    for (uint32_t i = 0; i < maps.size(); ++i) {
      const double error = segmentation::squared_error(space, v, maps[i]);
      if (error >= least) continue;
      least = error;
      best = i;
    }
    changed |= best != labels[v];
    labels[v] = best;
  }
  return changed;
}

}  // namespace

std::vector<uint32_t> cluster_motion(const segmentation::MotionInput& input, uint32_t count,
                                     uint32_t seed) {
  const MotionSpace space = segmentation::motion_space(input, kMaxFrames);
  std::vector<uint32_t> labels = voronoi_cells(space, count, seed);
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<AffineMap> maps;
    for (const auto& sums : segmentation::region_sums(space, labels, count)) {
      maps.push_back(segmentation::affine_fit(sums));
    }
    if (!reassign(space, maps, labels)) break;
  }
  return labels;
}

}  // namespace reeb::benchmark
