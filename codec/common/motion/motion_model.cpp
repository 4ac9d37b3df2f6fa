#include "codec/common/motion/motion_model.h"

#include <algorithm>

#include "codec/common/motion/motion_syntax.h"

namespace reeb {

std::vector<uint32_t> BindingCoder::regions_around(uint32_t row, uint32_t except) const {
  const PredictionGraph::Row& r = graph_.rows[row];
  std::vector<uint32_t> regions;
  std::vector<uint32_t> counts;
  for (uint32_t i = 0; i < r.ring; ++i) {
    const uint32_t region = bindings_[r.neighbour[i]].primary;
    if (region == except) continue;
    const auto at = std::find(regions.begin(), regions.end(), region);
    if (at == regions.end()) {
      regions.push_back(region);
      counts.push_back(1);
      continue;
    }
    auto i_at = static_cast<size_t>(at - regions.begin());
    ++counts[i_at];
    for (; i_at > 0 && counts[i_at] > counts[i_at - 1]; --i_at) {
      std::swap(counts[i_at], counts[i_at - 1]);
      std::swap(regions[i_at], regions[i_at - 1]);
    }
  }
  return regions;
}

uint32_t BindingCoder::blended_around(uint32_t row) const {
  const PredictionGraph::Row& r = graph_.rows[row];
  for (uint32_t i = 0; i < r.ring; ++i) {
    if (bindings_[r.neighbour[i]].weight > 0) return 1;
  }
  return 0;
}

void MotionModel::locate(const GridPoints& points, const std::vector<uint32_t>& order) {
  frames_.assign(regions_, {});
  position_.resize(order.size());
  std::vector<int64_t> members(regions_, 0);
  for (size_t row = 0; row < order.size(); ++row) {
    Frame& frame = frames_[bindings_[row].primary];
    for (int a = 0; a < 3; ++a) {
      position_[row][a] = points[order[row]][a];
      frame.centre[a] += position_[row][a];
    }
    ++members[bindings_[row].primary];
  }
  for (uint32_t b = 0; b < regions_; ++b) {
    for (int64_t& c : frames_[b].centre) c /= std::max<int64_t>(1, members[b]);
  }
  for (size_t row = 0; row < order.size(); ++row) {
    Frame& frame = frames_[bindings_[row].primary];
    for (int a = 0; a < 3; ++a) {
      const int64_t offset = position_[row][a] - frame.centre[a];
      frame.extent = std::max(frame.extent, offset < 0 ? -offset : offset);
    }
  }
}

std::array<float, MotionModel::kParameters> MotionModel::coordinates(uint32_t row,
                                                                     uint32_t region) const {
  const Frame& frame = frames_[region];
  const auto extent = static_cast<float>(frame.extent);
  std::array<float, kParameters> u{};
  for (int a = 0; a < 3; ++a)
    u[a] = static_cast<float>(position_[row][a] - frame.centre[a]) / extent;
  u[3] = 1.0f;
  return u;
}

float MotionModel::moved(uint32_t row, uint32_t region, uint32_t component) const {
  const Transform& z = transforms_[component][region];
  const std::array<float, kParameters> u = coordinates(row, region);
  float sum = 0;
  for (uint32_t i = 0; i < kParameters; ++i)
    sum += static_cast<float>(z[i]) * kTransformStep * u[i];
  return sum;
}

std::vector<float> MotionModel::predict(uint32_t component) const {
  std::vector<float> out(bindings_.size());
  for (uint32_t row = 0; row < out.size(); ++row) {
    const RegionBinding& b = bindings_[row];
    out[row] = moved(row, b.primary, component);
    if (b.weight == 0) continue;
    const float share =
        static_cast<float>(b.weight) / static_cast<float>(RegionBinding::kWeightUnit);
    const float other = moved(row, b.secondary, component);
    out[row] += share * (other - out[row]);
  }
  return out;
}

void add_motion(const MotionModel& motion, std::vector<std::vector<float>>& planes) {
  for (uint32_t k = 0; k < planes.size(); ++k) {
    const std::vector<float> moved = motion.predict(k);
    for (size_t row = 0; row < moved.size(); ++row) planes[k][row] += moved[row];
  }
}

}  // namespace reeb
