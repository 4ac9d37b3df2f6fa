#include "codec/enc/fields/karhunen_loeve.h"

#include <algorithm>

namespace reeb {

namespace {

constexpr Eigen::Index kComponentBlock =
    32;                             ///< components whose coefficients are computed at once
constexpr double kNothing = 1e-14;  ///< of the largest variance: rounding noise of the input

/// S^T S in binary64.
Eigen::MatrixXd gram_matrix(const TrajectoryMatrix& s) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(s.cols(), s.cols());
  for (Eigen::Index begin = 0; begin < s.rows(); begin += kRowBlock) {
    const Eigen::Index count = std::min(kRowBlock, s.rows() - begin);
    const Eigen::MatrixXd block = s.middleRows(begin, count).cast<double>();
    gram.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
  }
  return gram;
}

}  // namespace

KarhunenLoeve::KarhunenLoeve(const GroupSignal& signal) : signal_(signal) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram_matrix(signal.trajectories));
  const Eigen::VectorXd variance = solver.eigenvalues().reverse();
  const Eigen::Index most = std::min<Eigen::Index>(signal.trajectories.rows(), variance.size());
  Eigen::Index kept = 0;
  while (kept < most && variance[kept] > kNothing * variance[0]) ++kept;
  basis_ = solver.eigenvectors().rowwise().reverse().leftCols(kept);
  energies_ = variance.head(kept);
  coefficients_.resize(signal.trajectories.rows(), kept);
}

const float* KarhunenLoeve::coefficients(uint32_t k) {
  while (computed_ <= static_cast<Eigen::Index>(k)) {
    const Eigen::Index count = std::min(kComponentBlock, basis_.cols() - computed_);
    const Eigen::MatrixXf block = basis_.middleCols(computed_, count).cast<float>();
    coefficients_.middleCols(computed_, count).noalias() = signal_.trajectories * block;
    computed_ += count;
  }
  return coefficients_.col(k).data();
}

}  // namespace reeb
