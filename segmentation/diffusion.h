// Diffusion distance from the spectrum of a surface.
#pragma once

#include <Eigen/Core>

#include "segmentation/eigenpairs.h"

namespace reeb::segmentation {

/// Coordinates in which Euclidean distance is the diffusion distance
/// d_t(x, y)^2 = sum_i exp(-2 lambda_i t) (phi_i(x) - phi_i(y))^2. One column per vertex.
Eigen::MatrixXd diffusion_embedding(const Eigenpairs& pairs, double t);

/// Distance of each column of `embedding` to column `source`.
Eigen::VectorXd distances_from(const Eigen::MatrixXd& embedding, uint32_t source);

/// Distance of each column to the nearest of `sources` (at least one), divided by its maximum: 0
/// .. 1.
Eigen::VectorXd distance_function(const Eigen::MatrixXd& embedding,
                                  const std::vector<uint32_t>& sources);

}  // namespace reeb::segmentation
