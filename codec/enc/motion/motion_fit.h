// Fit of the affine motion model to a group: transforms of the regions and animation weights of the
// vertices, by alternating least squares on the coefficients of the temporal basis.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/motion/motion_model.h"
#include "codec/enc/reference/surface_context.h"

namespace reeb {

class MotionFit {
 public:
  /// `coefficients`: V x K in the order of the rows of the surface graph, world units; K components
  /// of the temporal basis, or coordinates (frame, axis). `labels`: region of each input vertex,
  /// 0 .. regions-1.
  MotionFit(const SurfaceContext& surface, Eigen::MatrixXf coefficients,
            std::span<const uint32_t> labels, uint32_t regions);

  /// The model as it is coded for the first `components` components, component k in units of
  /// step[k % 3].
  MotionModel quantize(const float (&step)[3], uint32_t components) const;

  uint32_t regions() const { return model_.regions(); }

 private:
  using Design = std::array<double, 2 * MotionModel::kParameters>;

  Design design(uint32_t row) const;
  Eigen::VectorXd moved(uint32_t row, uint32_t region) const;
  Eigen::VectorXd target(uint32_t row) const;
  void fit_transforms();
  void fit_weights();

  const SurfaceContext& surface_;
  Eigen::MatrixXf coefficients_;
  MotionModel model_;           ///< bindings and frames; no transforms
  Eigen::MatrixXd transforms_;  ///< 4R x K, world units
};

}  // namespace reeb
