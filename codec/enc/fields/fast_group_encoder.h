// Group encoder of the fast profile: the transform of the main profile, its two fields coded
// sixteen components at a time.
#pragma once

#include <cstdint>

#include "codec/enc/fields/lane_field_encoder.h"
#include "codec/enc/fields/transform_encoder.h"

namespace reeb {

class FastGroupEncoder : public TransformEncoder {
 public:
  FastGroupEncoder(GroupSignal signal, unsigned threads)
      : TransformEncoder(std::move(signal), {.residual = 1, .rate = 0.8}, threads) {}

 private:
  Planes encode_coefficients(const SurfaceContext& surface, const GroupSettings& settings,
                             const MotionFit* motion, GroupRun& run, CodedGroup& out) override;
  Planes code_basis(const Planes& targets, MagnitudeModel& contexts, CodedGroup& out) override;
};

}  // namespace reeb
