// Group encoder of the main profile: weights and contexts that follow what is coded.
#pragma once

#include "codec/enc/fields/transform_encoder.h"

namespace reeb {

class MainGroupEncoder : public TransformEncoder {
 public:
  MainGroupEncoder(GroupSignal signal, unsigned threads)
      : TransformEncoder(std::move(signal), {.residual = 0.8, .rate = 0.55}, threads) {}

 private:
  Planes encode_coefficients(const SurfaceContext& surface, const GroupSettings& settings,
                             const MotionFit* motion, GroupRun& run, CodedGroup& out) override;
  Planes encode_field(const SurfaceContext& surface, const GroupSettings& settings,
                      const MotionFit* motion, Field& field, CodedGroup& out);
  Planes code_basis(const Planes& targets, MagnitudeModel& contexts, CodedGroup& out) override;
};

}  // namespace reeb
