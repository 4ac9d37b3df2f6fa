#include "segmentation/affine_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace reeb::segmentation {
namespace {

// Added to the Gram matrix in units of its trace; far below the extent of any real region, far
// above rounding.
constexpr double kRidge = 1e-9;
// Principal components are dropped once they hold less than this part of the motion's energy in
// all.
constexpr double kDroppedEnergy = 1e-7;
// What is left of the motion below this part of its energy is rounding of the input.
constexpr double kRoundingEnergy = 1e-12;

Eigen::LDLT<Eigen::Matrix4d> factorised(const Eigen::Matrix4d& gram) {
  return (gram + kRidge * gram.trace() * Eigen::Matrix4d::Identity()).ldlt();
}

}  // namespace

Eigen::Matrix<double, 4, Eigen::Dynamic> position_corners(std::span<const float> positions) {
  const Eigen::Index count = static_cast<Eigen::Index>(positions.size() / 3);
  Eigen::Matrix<double, 4, Eigen::Dynamic> corners(4, count);
  corners.topRows(3) =
      Eigen::Map<const Eigen::Matrix3Xf>(positions.data(), 3, count).cast<double>();
  const Eigen::Vector3d centre = corners.topRows(3).rowwise().mean();
  corners.topRows(3).colwise() -= centre;
  const double extent = corners.topRows(3).cwiseAbs().maxCoeff();
  if (extent > 0) corners.topRows(3) /= extent;
  corners.row(3).setOnes();
  return corners;
}

MotionSpace motion_space(const MotionInput& input, uint32_t max_frames) {
  MotionSpace space;
  space.corners = position_corners(input.positions);
  const Eigen::Index vertices = space.corners.cols();
  const size_t frames = vertices > 0 ? input.frames.size() / input.positions.size() : 0;
  const size_t sampled = std::min<size_t>(frames, max_frames);
  Eigen::MatrixXd all(3 * static_cast<Eigen::Index>(sampled), vertices);
  for (size_t i = 0; i < sampled; ++i) {
    const float* frame = input.frames.data() + i * frames / sampled * input.positions.size();
    all.middleRows(3 * static_cast<Eigen::Index>(i), 3) =
        Eigen::Map<const Eigen::Matrix3Xf>(frame, 3, vertices).cast<double>();
  }
  if (sampled == 0) return space;
  space.scale = static_cast<double>(frames) / static_cast<double>(sampled);
  all.colwise() -= all.rowwise().mean().eval();
  const double rounding = kRoundingEnergy * all.squaredNorm();
  const Eigen::Matrix4d gram = space.corners * space.corners.transpose();
  const AffineMap map = factorised(gram).solve(space.corners * all.transpose());
  all -= map.transpose() * space.corners;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(all * all.transpose());
  const double total = std::max(solver.eigenvalues().sum(), 0.0);
  Eigen::Index kept = all.rows();
  double dropped = 0;
  while (kept > 0) {
    dropped += std::max(solver.eigenvalues()[all.rows() - kept], 0.0);
    if (dropped > std::max(kDroppedEnergy * total, rounding)) break;
    --kept;
  }
  space.rows = solver.eigenvectors().rightCols(kept).transpose() * all;
  return space;
}

void AffineSums::add(const MotionSpace& space, uint32_t vertex) {
  gram += space.corners.col(vertex) * space.corners.col(vertex).transpose();
  cross += space.corners.col(vertex) * space.rows.col(vertex).transpose();
  energy += space.rows.col(vertex).squaredNorm();
}

void AffineSums::add(const AffineSums& other) {
  gram += other.gram;
  cross += other.cross;
  energy += other.energy;
}

AffineMap affine_fit(const AffineSums& sums) {
  if (sums.cross.cols() == 0) return sums.cross;  // nothing moves
  return factorised(sums.gram).solve(sums.cross);
}

double residual(const AffineSums& sums) {
  const double explained = affine_fit(sums).cwiseProduct(sums.cross).sum();
  return std::max(sums.energy - explained, 0.0);
}

double squared_error(const MotionSpace& space, uint32_t vertex, const AffineMap& map) {
  return (space.rows.col(vertex) - map.transpose() * space.corners.col(vertex)).squaredNorm();
}

std::vector<AffineSums> region_sums(const MotionSpace& space, std::span<const uint32_t> labels,
                                    uint32_t region_count) {
  std::vector<AffineSums> sums(region_count, AffineSums(space.rows.rows()));
  for (uint32_t v = 0; v < labels.size(); ++v) sums[labels[v]].add(space, v);
  return sums;
}

}  // namespace reeb::segmentation
