#include "segmentation/eigenpairs.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace reeb::segmentation {
namespace {

// Up to here a dense solver is quicker and always converges.
constexpr Eigen::Index kDenseSize = 150;
constexpr Eigen::Index kMaxRestarts = 300;
constexpr double kTolerance = 1e-8;
// Shift in units of the smallest non-zero eigenvalue of a sphere of the same area, 8 pi / area. It
// only has to make the operator definite.
constexpr double kRelativeShift = 0.01;

// y = (B - sigma I)^-1 x for Spectra, with the sparse Cholesky factorisation of B - sigma I, sigma
// < 0.
class ShiftedInverse {
 public:
  using Scalar = double;

  explicit ShiftedInverse(const Eigen::SparseMatrix<double>& matrix) : matrix_(matrix) {}

  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }

  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = matrix_;
    for (Eigen::Index i = 0; i < rows(); ++i) shifted.coeffRef(i, i) -= sigma;
    solver_.compute(shifted);
  }

  bool factorised() const { return solver_.info() == Eigen::Success; }

  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd>(out, rows()) =
        solver_.solve(Eigen::Map<const Eigen::VectorXd>(in, rows()));
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

Eigenpairs dense_eigenpairs(const Eigen::SparseMatrix<double>& matrix, Eigen::Index count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(matrix)};
  if (solver.info() != Eigen::Success) return {};
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

Eigenpairs sparse_eigenpairs(const Eigen::SparseMatrix<double>& matrix, Eigen::Index count,
                             double sigma) {
  ShiftedInverse inverse(matrix);
  inverse.set_shift(sigma);
  if (!inverse.factorised()) return {};
  const Eigen::Index subspace = std::min(matrix.rows(), 2 * count + 20);
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, subspace, sigma);
  solver.init();
  // The largest of 1 / (lambda - sigma) are the smallest lambda.
  const Eigen::Index converged = solver.compute(Spectra::SortRule::LargestMagn, kMaxRestarts,
                                                kTolerance, Spectra::SortRule::SmallestAlge);
  return {solver.eigenvalues(), solver.eigenvectors(converged)};
}

}  // namespace

Eigenpairs smallest_eigenpairs(const Laplacian& laplacian, uint32_t count) {
  // With y = A^1/2 phi the problem is an ordinary symmetric one.
  const Eigen::VectorXd scale = laplacian.mass.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> matrix =
      scale.asDiagonal() * laplacian.stiffness * scale.asDiagonal();
  const Eigen::Index size = matrix.rows();
  Eigenpairs pairs;
  if (size <= kDenseSize || 2 * static_cast<Eigen::Index>(count) + 20 > size) {
    pairs = dense_eigenpairs(matrix, std::min<Eigen::Index>(count, size));
  } else {
    const double sigma = -kRelativeShift * 8 * 3.14159265358979 / laplacian.mass.sum();
    pairs = sparse_eigenpairs(matrix, count, sigma);
  }
  pairs.vectors = scale.asDiagonal() * pairs.vectors;
  return pairs;
}

}  // namespace reeb::segmentation
