#include "retrieval/smoothing.h"

#include <Eigen/SparseCholesky>

#include "segmentation/laplacian.h"

namespace reeb::retrieval {

segmentation::Surface smoothed(const segmentation::Surface& surface, double time) {
  const segmentation::Laplacian laplacian = build_laplacian(surface);
  Eigen::SparseMatrix<double> matrix = time * laplacian.mass.sum() * laplacian.stiffness;
  matrix += Eigen::SparseMatrix<double>(laplacian.mass.asDiagonal());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) return surface;
  Eigen::MatrixX3d positions(surface.vertex_count(), 3);
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) positions.row(v) = surface.points[v];
  positions = solver.solve(laplacian.mass.asDiagonal() * positions).eval();
  if (!positions.allFinite()) return surface;
  segmentation::Surface smooth = surface;
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) smooth.points[v] = positions.row(v);
  return smooth;
}

}  // namespace reeb::retrieval
