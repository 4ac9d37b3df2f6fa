#include "codec/enc/fields/basis_refit.h"

#include <algorithm>

namespace reeb {

namespace {
constexpr double kBasisRidge = 0.5;  ///< in units of q^2
constexpr double kRelativeRidge =
    1e-9;  ///< of the mean diagonal, against singular normal equations
}  // namespace

BasisRefit::BasisRefit(const GroupSignal& signal, const Eigen::MatrixXd& transform,
                       const std::vector<std::vector<float>>& planes,
                       const std::vector<uint32_t>& row_of, double q)
    : signal_(signal) {
  const auto k = static_cast<Eigen::Index>(planes.size());
  const Eigen::Index rows = signal.trajectories.rows();
  gram_.setZero(k, k);
  projection_.setZero(k, signal.trajectories.cols());
  sum_.setZero(k);
  for (Eigen::Index begin = 0; begin < rows && k > 0; begin += kRowBlock) {
    const Eigen::Index count = std::min(kRowBlock, rows - begin);
    Eigen::MatrixXd block(count, k);
    for (Eigen::Index c = 0; c < k; ++c) {
      for (Eigen::Index i = 0; i < count; ++i) {
        block(i, c) = static_cast<double>(
            planes[static_cast<size_t>(c)][row_of[static_cast<size_t>(begin + i)]]);
      }
    }
    gram_.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    projection_.noalias() +=
        block.transpose() * signal.trajectories.middleRows(begin, count).cast<double>();
    sum_ += block.colwise().sum().transpose();
  }
  if (k == 0) return;
  gram_ = gram_.selfadjointView<Eigen::Lower>();
  const double ridge = kBasisRidge + kRelativeRidge * gram_.trace() / static_cast<double>(k);
  const Eigen::MatrixXd normal = gram_ + ridge * Eigen::MatrixXd::Identity(k, k);
  const Eigen::MatrixXd right = projection_ / q + ridge * transform.leftCols(k).transpose();
  basis_ = normal.llt().solve(right).transpose();
}

double BasisRefit::squared_error(const GroupSynthesis& synthesis) const {
  double error = signal_.energy;
  Eigen::VectorXd u(gram_.rows());
  for (Eigen::Index row = 0; row < signal_.mean.size(); ++row) {
    const auto r = static_cast<size_t>(row);
    const double offset = synthesis.mean(r) - signal_.mean[row];
    for (Eigen::Index k = 0; k < u.size(); ++k)
      u[k] = synthesis.components().basis(r, static_cast<uint32_t>(k));
    error += u.dot(gram_ * u) - 2 * u.dot(projection_.col(row));
    error += offset * (offset * static_cast<double>(signal_.vertices()) + 2 * u.dot(sum_));
  }
  return std::max(0.0, error);
}

}  // namespace reeb
