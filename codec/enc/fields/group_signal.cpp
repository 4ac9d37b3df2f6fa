#include "codec/enc/fields/group_signal.h"

#include <algorithm>
#include <cmath>

namespace reeb {

GroupSignal make_group_signal(const Shot& shot, uint32_t first, uint32_t count) {
  const auto vertices = static_cast<Eigen::Index>(shot.connectivity.vertex_count);
  GroupSignal out;
  out.frames = count;
  out.mean.setZero(3 * Eigen::Index{count});
  out.trajectories.resize(vertices, 3 * Eigen::Index{count});
  using Frame = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  for (uint32_t t = 0; t < count; ++t) {
    const Eigen::Map<const Frame> frame(shot.frame(first + t).data(), vertices, 3);
    const Eigen::RowVector3d mean = frame.cast<double>().colwise().mean();
    out.mean.segment<3>(3 * Eigen::Index{t}) = mean;
    out.trajectories.middleCols<3>(3 * Eigen::Index{t}) =
        (frame.cast<double>().rowwise() - mean).cast<float>();
  }
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const double square = out.trajectories.row(v).cast<double>().squaredNorm();
    out.energy += square;
    out.largest = std::max(out.largest, std::sqrt(square));
  }
  return out;
}

}  // namespace reeb
