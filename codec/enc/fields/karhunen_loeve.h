// Temporal Karhunen-Loeve basis of a group: the principal components of its trajectories.
#pragma once

#include <Eigen/Dense>
#include <cstdint>

#include "codec/enc/fields/group_signal.h"

namespace reeb {

class KarhunenLoeve {
 public:
  /// `signal` must outlive the object.
  explicit KarhunenLoeve(const GroupSignal& signal);

  /// 3F x K orthonormal columns by falling variance; K <= min(V, 3F) leaves out what is numerically
  /// nothing.
  const Eigen::MatrixXd& basis() const { return basis_; }
  /// Energy of each component, world units squared.
  const Eigen::VectorXd& energies() const { return energies_; }
  /// Energy of each vertex, in input order, world units squared.
  Eigen::VectorXd row_energies() const {
    return signal_.trajectories.cast<double>().rowwise().squaredNorm();
  }
  uint32_t size() const { return static_cast<uint32_t>(basis_.cols()); }

  /// Coefficients of component k: V values in input order, world units. Computed when first asked
  /// for.
  const float* coefficients(uint32_t k);

 private:
  const GroupSignal& signal_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd energies_;
  Eigen::MatrixXf coefficients_;
  Eigen::Index computed_ = 0;
};

}  // namespace reeb
