// Least-squares fit of the temporal basis to what the decoder will have for coefficients.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "codec/common/synthesis/synthesis.h"
#include "codec/enc/fields/group_signal.h"

namespace reeb {

class BasisRefit {
 public:
  /// Minimises ||S - q R U^T||^2 + ridge ||U - U0||^2 over U, S the trajectories (world units), R
  /// the decoded planes (V x K, units of q; vertex v is row row_of[v]), U0 the first K columns of
  /// `transform`.
  BasisRefit(const GroupSignal& signal, const Eigen::MatrixXd& transform,
             const std::vector<std::vector<float>>& planes, const std::vector<uint32_t>& row_of,
             double q);

  /// 3F x K, dimensionless.
  const Eigen::MatrixXd& basis() const { return basis_; }

  /// Sum of squared errors of a synthesis from the same planes, by way of the normal equations:
  /// costs no pass over the trajectories.
  double squared_error(const GroupSynthesis& synthesis) const;

 private:
  const GroupSignal& signal_;
  Eigen::MatrixXd gram_;        ///< R^T R, K x K
  Eigen::MatrixXd projection_;  ///< R^T S, K x 3F
  Eigen::VectorXd sum_;         ///< sum of each plane, K
  Eigen::MatrixXd basis_;
};

}  // namespace reeb
