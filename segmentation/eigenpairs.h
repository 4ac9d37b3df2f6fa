// Smallest eigenpairs of the Laplace-Beltrami operator.
#pragma once

#include <Eigen/Core>

#include "segmentation/laplacian.h"

namespace reeb::segmentation {

struct Eigenpairs {
  Eigen::VectorXd values;   ///< ascending, n; the first is 0 up to rounding
  Eigen::MatrixXd vectors;  ///< V x n, orthonormal with respect to the areas: phi^T A phi = 1

  bool empty() const { return values.size() == 0; }
};

/// The `count` smallest eigenpairs of W phi = lambda A phi of a connected surface, or as many as
/// the surface has or as converged; empty when the operator could not be factorised.
Eigenpairs smallest_eigenpairs(const Laplacian& laplacian, uint32_t count);

}  // namespace reeb::segmentation
