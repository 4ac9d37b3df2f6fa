// Encoder of one group of frames at a given quantization step.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/prediction_graph.h"
#include "codec/common/synthesis.h"
#include "codec/enc/group_signal.h"
#include "codec/enc/karhunen_loeve.h"

namespace reeb {

/// One encoding of a group.
struct CodedGroup {
  double q = 0;
  uint32_t component_count = 0;
  std::vector<uint8_t> coefficients;
  std::vector<uint8_t> basis;
  GroupSynthesis synthesis;  ///< what the decoder will have
  double squared_error =
      0;  ///< over all vertices, frames and axes, but for the rounding to binary32
};

/// What a group needs to know of its reference mesh.
struct SurfaceContext {
  const SurfaceGraph& surface;
  GridPoints points;  ///< decoded reference positions
  const float* origin;
};

class GroupEncoder {
 public:
  /// The surface's parts must outlive the encoder.
  GroupEncoder(const SurfaceContext& surface, GroupSignal signal, bool fast_profile,
               unsigned threads);

  /// Encodes with quantization step q > 0, world units.
  CodedGroup encode(double q);

  const GroupSignal& signal() const { return signal_; }

 private:
  std::vector<std::vector<float>> encode_coefficients(double q, CodedGroup& out);
  void encode_basis(const std::vector<std::vector<float>>& planes, CodedGroup& out);

  SurfaceContext surface_;
  GroupSignal signal_;
  TemporalGraph temporal_;
  KarhunenLoeve transform_;
  bool fast_profile_;
  unsigned threads_;
};

}  // namespace reeb
