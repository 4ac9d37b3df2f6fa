// Plain clustering of vertices by their motion, the yardstick of the regions.
#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/motion.h"

namespace reeb::benchmark {

/// Labels 0 .. count-1 by alternating affine fits per cluster and reassignment of every vertex to
/// the cluster that predicts it best, wherever it lies on the surface (k-means style), until
/// nothing moves or 100 rounds have passed. Starts from the Voronoi cells of `count` points far
/// from each other, the first one by `seed`.
std::vector<uint32_t> cluster_motion(const segmentation::MotionInput& input, uint32_t count,
                                     uint32_t seed);

}  // namespace reeb::benchmark
