// Group encoder of the main and the fast profile: temporal Karhunen-Loeve basis, prediction along
// the surface.
#pragma once

#include <vector>

#include "codec/enc/group_encoder.h"
#include "codec/enc/karhunen_loeve.h"

namespace reeb {

class TransformEncoder : public GroupEncoder {
 public:
  TransformEncoder(GroupSignal signal, Profile profile, unsigned threads);

  CodedGroup encode(const SurfaceContext& surface, double q, const MotionFit* motion,
                    GroupRun& run) override;
  double expected_error(double q) const override;
  Eigen::MatrixXf motion_targets(const SurfaceContext& surface) override;

 private:
  Planes encode_coefficients(const SurfaceContext& surface, const MotionFit* motion, Field& field,
                             CodedGroup& out);
  void encode_basis(const SurfaceContext& surface, const Planes& planes, MagnitudeModel& contexts,
                    CodedGroup& out);

  TemporalGraph temporal_;
  KarhunenLoeve transform_;
  Profile profile_;
  unsigned threads_;
};

}  // namespace reeb
