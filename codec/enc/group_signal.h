// The trajectories of one group of frames, as the encoder's linear algebra sees them.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/sequence.h"

namespace reeb {

using TrajectoryMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct GroupSignal {
  uint32_t frames = 0;
  TrajectoryMatrix
      trajectories;  ///< V x 3F, row r is the trajectory of row r of the surface graph, less `mean`
  Eigen::VectorXd mean;  ///< 3F, mean trajectory relative to the origin of the reference grid
  double energy = 0;     ///< sum of squares of `trajectories`

  uint32_t vertices() const { return static_cast<uint32_t>(trajectories.rows()); }
};

/// Frames [first, first + count) of the shot; `output[row]` is the vertex of a row.
GroupSignal make_group_signal(const Shot& shot, uint32_t first, uint32_t count,
                              std::span<const uint32_t> output, const float origin[3]);

}  // namespace reeb
