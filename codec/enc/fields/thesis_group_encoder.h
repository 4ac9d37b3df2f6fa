// Group encoder of the thesis profile: affine motion of the regions per frame with animation
// weights, and the residual of each coordinate quantized with a step of its own (M. Hachani, 2015,
// chapter 4). It shows what later tools gain.
#pragma once

#include "codec/enc/fields/group_encoder.h"

namespace reeb {

class ThesisGroupEncoder : public GroupEncoder {
 public:
  ThesisGroupEncoder(GroupSignal signal, unsigned threads)
      : GroupEncoder(std::move(signal)), threads_(threads) {}

  CodedGroup encode(const SurfaceContext& surface, const GroupSettings& settings,
                    const MotionFit* motion, GroupRun& run) override;
  RatePoint expect(const SurfaceContext& surface, const GroupSettings& settings) override;
  /// Positions less the origin, column 3 t + axis.
  Eigen::MatrixXf motion_targets(const SurfaceContext& surface) override;

 private:
  void choose_steps(const Eigen::MatrixXf& targets, const MotionFit* motion, CodedGroup& out) const;

  unsigned threads_;
};

}  // namespace reeb
