// Fit of the affine motion model to a group: transforms of the regions and animation weights of the
// vertices, by alternating least squares on the coefficients of the temporal basis.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/motion_model.h"
#include "codec/enc/karhunen_loeve.h"
#include "codec/enc/surface_context.h"

namespace reeb {

class MotionFit {
 public:
  /// `labels`: region of each input vertex, 0 .. regions-1.
  MotionFit(const SurfaceContext& surface, KarhunenLoeve& transform,
            std::span<const uint32_t> labels, uint32_t regions);

  /// The model as it is coded at quantization step q, for the first `components` components.
  MotionModel quantize(double q, uint32_t components) const;

  uint32_t regions() const { return model_.regions(); }

 private:
  using Design = std::array<double, 2 * MotionModel::kParameters>;

  Design design(uint32_t row) const;
  Eigen::VectorXd moved(uint32_t row, uint32_t region) const;
  Eigen::VectorXd target(uint32_t row) const;
  void fit_transforms();
  void fit_weights();

  const SurfaceContext& surface_;
  Eigen::MatrixXf coefficients_;  ///< V x K, rows as the surface graph, world units
  MotionModel model_;             ///< bindings and frames; no transforms
  Eigen::MatrixXd transforms_;    ///< 4R x K, world units
};

}  // namespace reeb
