#include "codec/enc/group_signal.h"

namespace reeb {

GroupSignal make_group_signal(const Shot& shot, uint32_t first, uint32_t count,
                              std::span<const uint32_t> output, const float origin[3]) {
  const auto vertices = static_cast<Eigen::Index>(output.size());
  GroupSignal out;
  out.frames = count;
  out.mean.setZero(3 * count);
  out.trajectories.resize(vertices, 3 * count);
  for (uint32_t t = 0; t < count; ++t) {
    const std::span<const float> frame = shot.frame(first + t);
    for (int a = 0; a < 3; ++a) {
      double sum = 0;
      for (const uint32_t v : output) sum += static_cast<double>(frame[size_t{v} * 3 + a]);
      const double mean = sum / static_cast<double>(vertices);
      out.mean[3 * t + a] = mean - static_cast<double>(origin[a]);
      for (Eigen::Index r = 0; r < vertices; ++r) {
        const double x = static_cast<double>(frame[size_t{output[r]} * 3 + a]) - mean;
        out.trajectories(r, 3 * t + a) = static_cast<float>(x);
      }
    }
  }
  for (Eigen::Index r = 0; r < vertices; ++r) {
    out.energy += out.trajectories.row(r).cast<double>().squaredNorm();
  }
  return out;
}

}  // namespace reeb
