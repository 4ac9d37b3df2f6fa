// Signed curvature of a surface.
#pragma once

#include <Eigen/Core>

#include "segmentation/laplacian.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Smaller principal curvature per vertex, in 1 / (units of the input), from the mean curvature
/// normal and the angle defect, averaged `rounds` times over the neighbours. Negative in valleys
/// and joints, 1/r on a sphere of radius r whichever way its triangles turn. All 0 when the
/// triangles are not consistently oriented.
Eigen::VectorXd minimal_curvature(const Surface& surface, const Laplacian& laplacian, int rounds);

}  // namespace reeb::segmentation
