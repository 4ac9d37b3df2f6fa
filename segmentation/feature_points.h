// Extremities of a shape.
#pragma once

#include <Eigen/Core>

#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Local maxima of `f` over the vertices that rise at least `persistence` (in units of f) above the
/// highest pass to a higher maximum, ascending by vertex. The global maximum is always one.
std::vector<uint32_t> persistent_maxima(const Surface& surface, const Eigen::VectorXd& f,
                                        double persistence);

/// Two vertices as far apart as repeated jumps to the farthest column of `embedding` find.
std::array<uint32_t, 2> farthest_pair(const Eigen::MatrixXd& embedding);

/// The extremities: extrema both of the distance to v1 and of the distance to v2, v1 and v2 being
/// the farthest pair. `persistence` is a part of the range of a distance, `radius` a length along
/// the surface within which two extrema count as one. At least two vertices, ascending, when the
/// surface has a farthest pair.
std::vector<uint32_t> feature_points(const Surface& surface, const Eigen::MatrixXd& embedding,
                                     double persistence, double radius);

}  // namespace reeb::segmentation
