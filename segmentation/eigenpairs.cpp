#include "segmentation/eigenpairs.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>
#include <vector>

namespace reeb::segmentation {
namespace {

// Up to here a dense solver is quicker and always converges.
constexpr Eigen::Index kDenseSize = 150;
constexpr Eigen::Index kMaxRestarts = 300;
constexpr double kTolerance = 1e-8;
// Shift in units of the smallest non-zero eigenvalue of a sphere of the same area, 8 pi / area. It
// only has to make the operator definite.
constexpr double kRelativeShift = 0.01;

constexpr double kCountMargin = 1e-5;
// Runs of the Lanczos method: one finds a single vector of a multiple eigenvalue, as symmetric
// shapes have them.
constexpr int kMaxRuns = 8;

using SparseMatrix = Eigen::SparseMatrix<double>;

// Factorises B - shift I again and again.
class ShiftedSolver {
 public:
  explicit ShiftedSolver(const SparseMatrix& matrix) : matrix_(matrix) {
    solver_.analyzePattern(matrix);
  }

  bool factorise(double shift) {
    solver_.setShift(-shift);
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return solver_.solve(b); }

  /// Eigenvalues of B below the shift: the negative pivots (Sylvester's law of inertia).
  Eigen::Index count_below() const { return (solver_.vectorD().array() < 0).count(); }

 private:
  const SparseMatrix& matrix_;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

// y = (B - sigma I)^-1 x for Spectra, the eigenvectors in `known` being mapped to 0.
class DeflatedInverse {
 public:
  using Scalar = double;

  DeflatedInverse(const ShiftedSolver& solver, const Eigen::MatrixXd& known)
      : solver_(solver), known_(known) {}

  Eigen::Index rows() const { return known_.rows(); }
  Eigen::Index cols() const { return known_.rows(); }
  void set_shift(double) {}  // the solver has it already

  void perform_op(const double* in, double* out) const {
    const Eigen::VectorXd x = without_known(Eigen::Map<const Eigen::VectorXd>(in, rows()));
    Eigen::Map<Eigen::VectorXd>(out, rows()) = without_known(solver_.solve(x));
  }

 private:
  Eigen::VectorXd without_known(Eigen::VectorXd x) const {
    if (known_.cols() > 0) x -= known_ * (known_.transpose() * x);
    return x;
  }

  const ShiftedSolver& solver_;
  const Eigen::MatrixXd& known_;
};

Eigenpairs dense_eigenpairs(const SparseMatrix& matrix, Eigen::Index count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(matrix)};
  if (solver.info() != Eigen::Success) return {};
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

Eigenpairs lanczos(const ShiftedSolver& solver, const Eigen::MatrixXd& known, Eigen::Index count,
                   double sigma) {
  DeflatedInverse inverse(solver, known);
  const Eigen::Index subspace = std::min(known.rows(), 2 * count + 20);
  Spectra::SymEigsShiftSolver<DeflatedInverse> spectra(inverse, count, subspace, sigma);
  spectra.init();
  // The largest of 1 / (lambda - sigma) are the smallest lambda.
  const Eigen::Index converged = spectra.compute(Spectra::SortRule::LargestMagn, kMaxRestarts,
                                                 kTolerance, Spectra::SortRule::SmallestAlge);
  return {spectra.eigenvalues(), spectra.eigenvectors(converged)};
}

// The `count` smallest of both sets, ascending.
Eigenpairs smallest_of(const Eigenpairs& a, const Eigenpairs& b, Eigen::Index count) {
  Eigenpairs all;
  all.values.resize(a.values.size() + b.values.size());
  all.values << a.values, b.values;
  all.vectors.resize(a.vectors.rows(), all.values.size());
  all.vectors << a.vectors, b.vectors;
  std::vector<Eigen::Index> order(static_cast<size_t>(all.values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index i, Eigen::Index j) { return all.values[i] < all.values[j]; });
  order.resize(static_cast<size_t>(std::min(count, all.values.size())));
  return {all.values(order), all.vectors(Eigen::all, order)};
}

Eigenpairs sparse_eigenpairs(const SparseMatrix& matrix, Eigen::Index count, double sigma) {
  ShiftedSolver solver(matrix), counter(matrix);
  if (!solver.factorise(sigma)) return {};
  Eigenpairs pairs = lanczos(solver, Eigen::MatrixXd(matrix.rows(), 0), count, sigma);
  for (int run = 1; run < kMaxRuns && pairs.values.size() > 0; ++run) {
    // Just below the largest value found none may be missing.
    const double bound = pairs.values.tail(1)[0] * (1 - kCountMargin);
    if (!counter.factorise(bound)) break;
    const Eigen::Index missing = counter.count_below() - (pairs.values.array() < bound).count();
    if (missing <= 0) break;
    const Eigenpairs more = lanczos(solver, pairs.vectors, std::min(missing, count), sigma);
    if (more.values.size() == 0) break;
    pairs = smallest_of(pairs, more, count);
  }
  return pairs;
}

}  // namespace

Eigenpairs smallest_eigenpairs(const Laplacian& laplacian, uint32_t count) {
  // With y = A^1/2 phi the problem is an ordinary symmetric one.
  const Eigen::VectorXd scale = laplacian.mass.cwiseSqrt().cwiseInverse();
  const SparseMatrix matrix = scale.asDiagonal() * laplacian.stiffness * scale.asDiagonal();
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
