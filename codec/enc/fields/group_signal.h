// The trajectories of one group of frames, as the encoder's linear algebra sees them.
#pragma once

#include <Eigen/Dense>
#include <cstdint>

#include "codec/common/base/sequence.h"

namespace reeb {

using TrajectoryMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline constexpr Eigen::Index kRowBlock = 512;  ///< rows turned to binary64 at once

struct GroupSignal {
  uint32_t frames = 0;
  TrajectoryMatrix
      trajectories;      ///< V x 3F, trajectories of the vertices in input order, less `mean`
  Eigen::VectorXd mean;  ///< 3F, mean trajectory
  double energy = 0;     ///< sum of squares of `trajectories`
  double largest = 0;    ///< norm of the longest trajectory

  uint32_t vertices() const { return static_cast<uint32_t>(trajectories.rows()); }
};

/// Frames [first, first + count) of the shot.
GroupSignal make_group_signal(const Shot& shot, uint32_t first, uint32_t count);

}  // namespace reeb
