// Group encoder of the fast profile: the transform of the main profile, its two fields coded
// sixteen components at a time.
#pragma once

#include <cstdint>

#include "codec/enc/fields/lane_field_encoder.h"
#include "codec/enc/fields/transform_encoder.h"

namespace reeb {

class FastEncoder : public TransformEncoder {
 public:
  using TransformEncoder::TransformEncoder;

 private:
  Planes encode_coefficients(const SurfaceContext& surface, const MotionFit* motion, GroupRun& run,
                             CodedGroup& out) override;
  Planes code_basis(const std::vector<std::vector<float>>& targets, MagnitudeModel& contexts,
                    CodedGroup& out) override;
};

}  // namespace reeb
