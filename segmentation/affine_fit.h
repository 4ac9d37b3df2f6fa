// Least-squares affine motion of sets of vertices, in a reduced space of trajectories.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "segmentation/motion.h"

namespace reeb::segmentation {

/// 4 x K: predicts a row of K from a corner, row = map^T corner.
using AffineMap = Eigen::Matrix<double, 4, Eigen::Dynamic>;

/// The motion of a sequence as one short row per vertex. Differences of rows are those of
/// trajectories up to a rotation, what one affine map of the whole mesh explains being taken out:
/// every region's best affine fit explains that as well, so no residual of a fit changes.
struct MotionSpace {
  Eigen::Matrix<double, 4, Eigen::Dynamic>
      corners;           ///< per vertex, its centred and scaled position and 1
  Eigen::MatrixXd rows;  ///< K x V
  double scale = 1;      ///< squared residuals times this are those of all frames
};

/// The corners of a MotionSpace.
Eigen::Matrix<double, 4, Eigen::Dynamic> position_corners(std::span<const float> positions);

/// Samples at most `max_frames` frames evenly and keeps the principal components of the
/// trajectories.
MotionSpace motion_space(const MotionInput& input, uint32_t max_frames);

/// Sums over a set of vertices from which its best affine fit and its error follow.
struct AffineSums {
  Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();  ///< sum of corner corner^T
  Eigen::Matrix<double, 4, Eigen::Dynamic> cross;  ///< sum of corner row^T, 4 x K
  double energy = 0;                               ///< sum of squared rows

  explicit AffineSums(Eigen::Index components)
      : cross(Eigen::Matrix<double, 4, Eigen::Dynamic>::Zero(4, components)) {}
  void add(const MotionSpace& space, uint32_t vertex);
  void add(const AffineSums& other);
};

/// Best affine map of the set. Directions in which the set has no extent get
/// no motion of their own.
AffineMap affine_fit(const AffineSums& sums);

/// Sum of the squared residuals of affine_fit, at least 0.
double residual(const AffineSums& sums);

/// Squared error of predicting the row of `vertex`.
double squared_error(const MotionSpace& space, uint32_t vertex, const AffineMap& map);

/// Sums of each region 0 .. region_count-1.
std::vector<AffineSums> region_sums(const MotionSpace& space, std::span<const uint32_t> labels,
                                    uint32_t region_count);

}  // namespace reeb::segmentation
