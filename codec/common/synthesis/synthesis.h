// From decoded components to positions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/common/synthesis/component_sum.h"
#include "codec/common/synthesis/corrections.h"
#include "codec/common/synthesis/exact_frames.h"

namespace reeb {

/// A decoded group, ready to give any of its frames.
class GroupSynthesis {
 public:
  GroupSynthesis() = default;
  /// `sum`: the components, moved by `mean`: 3F values, the mean trajectory in world units.
  GroupSynthesis(ComponentSum sum, std::vector<double> mean);

  /// Thesis profile: plane 3 t + a holds coordinate a of frame t, less `origin`, in units of
  /// `axis_step[a]`. `output`: row -> vertex; must outlive this.
  GroupSynthesis(std::vector<std::vector<float>> planes, const float axis_step[3],
                 const float origin[3], std::span<const uint32_t> output);

  /// Of as many frames as the group; applied to every frame from now on.
  void set_corrections(Corrections corrections) { corrections_ = std::move(corrections); }

  /// Lossless profile: the frames as they are. `output` as above.
  GroupSynthesis(ExactFrames exact, std::span<const uint32_t> output)
      : output_(output), exact_(std::move(exact)) {}

  uint32_t frame_count() const {
    return std::max(exact_.frame_count(), static_cast<uint32_t>(mean_.size() / 3));
  }
  /// False where basis or mean trajectory is beyond binary32 or binary64: no position is defined.
  bool finite() const;
  /// Mean trajectory in row = time * 3 + axis, world units.
  double mean(size_t row) const { return mean_[row]; }
  const ComponentSum& components() const { return sum_; }

  /// Writes frames first .. first + count - 1, vertex v of frame t to xyz + (t - first) *
  /// frame_stride + v * stride. Several at once take less time than one after another.
  void frames(uint32_t first, uint32_t count, float* xyz, size_t frame_stride, size_t stride) const;
  void frame(uint32_t t, float* xyz, size_t stride) const { frames(t, 1, xyz, 0, stride); }

 private:
  void direct_frame(uint32_t t, float* xyz, size_t stride) const;

  ComponentSum sum_;
  std::vector<double> mean_;
  std::vector<std::vector<float>> planes_;  ///< thesis profile; none in the others
  float axis_step_[3] = {};
  std::span<const uint32_t> output_;  ///< thesis and lossless profile
  Corrections corrections_;
  ExactFrames exact_;  ///< lossless profile; none in the others
};

/// Euclidean norms of planes of one length, summed in binary64 in the order of their rows.
std::vector<double> plane_norms(const std::vector<std::vector<float>>& planes);

/// Joins the two decoded fields of a group. The coefficient field holds K planes of V values in
/// units of the quantization step q; the basis field 1 + K planes of 3F values in the order of the
/// temporal graph: the mean trajectory times sqrt(V), then each basis vector times the norm of its
/// plane, both in units of q. `origin` is added to the mean trajectory. `output`: row of the planes
/// -> vertex.
GroupSynthesis synthesize(std::vector<std::vector<float>> planes,
                          const std::vector<std::vector<float>>& basis_planes,
                          const std::vector<uint32_t>& basis_order, double q, const float origin[3],
                          std::span<const uint32_t> output);

}  // namespace reeb
