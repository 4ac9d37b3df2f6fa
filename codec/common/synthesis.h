// From decoded components to positions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/common/corrections.h"
#include "codec/common/exact_frames.h"
#include "codec/common/kernels.h"

namespace reeb {

/// A decoded group, ready to give any of its frames.
class GroupSynthesis {
 public:
  GroupSynthesis() = default;
  /// `planes`: K components of V values; `basis`: K components of 3F values, [time][axis], world
  /// units per unit of the plane; `mean`: 3F values, the mean trajectory in world units.
  GroupSynthesis(std::vector<std::vector<float>> planes,
                 const std::vector<std::vector<float>>& basis, std::vector<double> mean);

  /// Thesis profile: plane 3 t + a holds coordinate a of frame t, less `origin`, in units of
  /// `axis_step[a]`.
  GroupSynthesis(std::vector<std::vector<float>> planes, const float axis_step[3],
                 const float origin[3]);

  /// Of as many frames as the group; applied to every frame from now on.
  void set_corrections(Corrections corrections) { corrections_ = std::move(corrections); }

  /// Lossless profile: the frames as they are.
  explicit GroupSynthesis(ExactFrames exact) : exact_(std::move(exact)) {}

  uint32_t frame_count() const {
    return std::max(exact_.frame_count(), static_cast<uint32_t>(mean_.size() / 3));
  }
  /// False where basis or mean trajectory is beyond binary32 or binary64: no position is defined.
  bool finite() const;
  /// Mean trajectory and the K basis values of row = time * 3 + axis, world units.
  double mean(size_t row) const { return mean_[row]; }
  const float* basis(size_t row) const { return basis_.data() + row * component_count_; }

  /// x(v, t) = round(mean(t) + sum_k basis_k(t) plane_k(v)): the sum in binary32 in the order of k,
  /// the last addition in binary64, rounded once to binary32, then corrected. Row r is written to
  /// xyz + output[r] * stride.
  void frame(uint32_t t, std::span<const uint32_t> output, float* xyz, size_t stride) const;

 private:
  /// Rows first .. first + count - 1 of a tile, before corrections.
  void tile_positions(uint32_t t, uint32_t first, uint32_t count, float (*out)[kTileRows]) const;

  std::vector<std::vector<float>> planes_;  ///< thesis profile
  uint32_t component_count_ = 0;
  std::vector<float> tiles_;  ///< [tile][component][row], kTileRows rows a tile, padded with 0
  std::vector<float> basis_;  ///< [time][axis][component]; [axis] in the thesis profile
  bool direct_ = false;       ///< planes are coordinates: the thesis profile
  std::vector<double> mean_;
  Corrections corrections_;
  ExactFrames exact_;  ///< lossless profile; none in the others
  Kernels kernels_ = fastest_kernels();
};

/// Euclidean norm of a plane, summed in binary64 in the order of its rows.
double plane_norm(const std::vector<float>& plane);

/// Joins the two decoded fields of a group. The coefficient field holds K planes of V values in
/// units of the quantization step q; the basis field 1 + K planes of 3F values in the order of the
/// temporal graph: the mean trajectory times sqrt(V), then each basis vector times the norm of its
/// plane, both in units of q. `origin` is added to the mean trajectory.
GroupSynthesis synthesize(uint32_t vertices, std::vector<std::vector<float>> planes,
                          const std::vector<std::vector<float>>& basis_planes,
                          const std::vector<uint32_t>& basis_order, double q,
                          const float origin[3]);

}  // namespace reeb
