// Discrete Laplace-Beltrami operator of a surface.
#pragma once

#include <Eigen/SparseCore>

#include "segmentation/surface.h"

namespace reeb::segmentation {

/// W phi = lambda A phi with natural (Neumann) conditions at boundaries.
struct Laplacian {
  Eigen::SparseMatrix<double>
      stiffness;         ///< W: V x V, symmetric, positive semidefinite, rows sum to 0
  Eigen::VectorXd mass;  ///< diagonal of A: area of each vertex, > 0
};

/// Cotangent weights and mixed Voronoi areas (Meyer, Desbrun, Schroeder, Barr, "Discrete
/// differential-geometry operators for triangulated 2-manifolds", 2003), from edge lengths that are
/// first made to satisfy the triangle inequality with a margin (Sharp, Crane, "A Laplacian for
/// nonmanifold triangle meshes", 2020), so that slivers and degenerate triangles stay finite.
/// `surface` has a positive mean edge length.
Laplacian build_laplacian(const Surface& surface);

}  // namespace reeb::segmentation
