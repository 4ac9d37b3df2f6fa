#include <algorithm>
#include <cmath>

#include "segmentation/affine_fit.h"

namespace reeb::segmentation {

double motion_error(const MotionInput& input, std::span<const uint32_t> labels) {
  if (labels.empty() || input.frames.empty()) return 0;
  const uint32_t regions = *std::max_element(labels.begin(), labels.end()) + 1;
  const Eigen::Index vertices = static_cast<Eigen::Index>(labels.size());
  MotionSpace frame;
  frame.corners = position_corners(input.positions);
  double error = 0, signal = 0;
  for (size_t at = 0; at < input.frames.size(); at += input.positions.size()) {
    frame.rows =
        Eigen::Map<const Eigen::Matrix3Xf>(input.frames.data() + at, 3, vertices).cast<double>();
    frame.rows.colwise() -= frame.rows.rowwise().mean().eval();
    signal += frame.rows.squaredNorm();
    std::vector<AffineMap> maps;
    for (const AffineSums& sums : region_sums(frame, labels, regions))
      maps.push_back(affine_fit(sums));
    for (uint32_t v = 0; v < labels.size(); ++v) error += squared_error(frame, v, maps[labels[v]]);
  }
  return signal > 0 ? 100 * std::sqrt(error / signal) : 0;
}

}  // namespace reeb::segmentation
