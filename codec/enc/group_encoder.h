// Encoder of one group of frames at a given quantization step.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/prediction_graph.h"
#include "codec/common/synthesis.h"
#include "codec/enc/group_signal.h"
#include "codec/enc/karhunen_loeve.h"
#include "codec/enc/motion_fit.h"
#include "codec/enc/surface_context.h"

namespace reeb {

/// One encoding of a group.
struct CodedGroup {
  double q = 0;
  uint32_t component_count = 0;
  uint32_t region_count = 0;
  std::vector<uint8_t> motion;
  std::vector<uint8_t> coefficients;
  std::vector<uint8_t> basis;
  GroupSynthesis synthesis;  ///< what the decoder will have
  double squared_error =
      0;  ///< over all vertices, frames and axes, but for the rounding to binary32
};

class GroupEncoder {
 public:
  GroupEncoder(GroupSignal signal, bool fast_profile, unsigned threads);
  GroupEncoder(const GroupEncoder&) = delete;
  GroupEncoder& operator=(const GroupEncoder&) = delete;

  /// Encodes on a reference mesh with quantization step q > 0, world units. `motion` may be null.
  CodedGroup encode(const SurfaceContext& surface, double q, const MotionFit* motion);

  const GroupSignal& signal() const { return signal_; }
  KarhunenLoeve& transform() { return transform_; }

 private:
  using Planes = std::vector<std::vector<float>>;

  Planes encode_coefficients(const SurfaceContext& surface, const MotionFit* motion,
                             CodedGroup& out);
  void encode_motion(const SurfaceContext& surface, const MotionFit& motion, CodedGroup& out,
                     Planes& planes);
  void encode_basis(const SurfaceContext& surface, const Planes& planes, CodedGroup& out);

  GroupSignal signal_;
  TemporalGraph temporal_;
  KarhunenLoeve transform_;
  bool fast_profile_;
  unsigned threads_;
};

}  // namespace reeb
