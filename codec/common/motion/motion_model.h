// Affine motion of regions, blended by animation weights, in the temporal basis of a group:
// component k of a vertex is predicted as sum_b w_vb [u_vb; 1] . z_bk, u_vb being its reference
// position seen from region b.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/mesh/grid.h"
#include "codec/common/prediction/prediction_graph.h"
#include "entropy/adaptive_bit.h"
#include "entropy/integer_coder.h"

namespace reeb {

/// The region a row moves with, and one more that it may lean on.
struct RegionBinding {
  static constexpr uint32_t kWeightUnit = 16;
  static constexpr uint32_t kMaxWeight = 8;  ///< the first region keeps at least half

  uint32_t primary = 0;
  uint32_t secondary = 0;
  uint32_t weight = 0;  ///< of the secondary region, in 1/kWeightUnit; 0 where there is none

  bool operator==(const RegionBinding&) const = default;
};

class MotionModel {
 public:
  static constexpr uint32_t kMaxRegions = 1024;
  static constexpr uint32_t kParameters = 4;     ///< x, y, z, constant
  static constexpr float kTransformStep = 0.5f;  ///< of a transform entry, in units of q
  /// Stride that makes each transform of the thesis profile follow that of the frame before.
  static constexpr uint32_t kFrameStride = 3;
  using Transform = std::array<int32_t, kParameters>;

  MotionModel() = default;
  MotionModel(uint32_t regions, uint32_t components) : regions_(regions), transforms_(components) {}

  uint32_t regions() const { return regions_; }
  void set_components(uint32_t components) { transforms_.resize(components); }
  std::vector<RegionBinding>& bindings() { return bindings_; }
  const std::vector<RegionBinding>& bindings() const { return bindings_; }
  /// Transforms of component k, one a region; empty before they are set or coded.
  std::vector<Transform>& transforms(uint32_t component) { return transforms_[component]; }

  /// Codes bindings and transforms, each transform as its difference from the one `stride`
  /// components before where `stride` is not 0. False where decoded values are out of range.
  template <class Coder>
  bool code(Coder& coder, const PredictionGraph& graph, uint32_t stride);

  /// Fixes the frames of the regions once the bindings are known: centre and extent of their
  /// vertices.
  void locate(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Position of a row in a region's frame, about -1 .. 1, and 1.
  std::array<float, kParameters> coordinates(uint32_t row, uint32_t region) const;

  /// Prediction of component k, in units of q, for all rows.
  std::vector<float> predict(uint32_t component) const;

 private:
  struct Frame {
    std::array<int64_t, 3> centre{};
    int64_t extent = 1;
  };
  float moved(uint32_t row, uint32_t region, uint32_t component) const;

  uint32_t regions_ = 0;
  std::vector<RegionBinding> bindings_;             ///< one a row
  std::vector<std::vector<Transform>> transforms_;  ///< [component][region]
  std::vector<Frame> frames_;
  std::vector<std::array<int32_t, 3>> position_;  ///< grid position of each row
};

/// planes[k] += prediction of component k.
void add_motion(const MotionModel& motion, std::vector<std::vector<float>>& planes);

}  // namespace reeb
