// Encoder of one group of frames at a given quantization step.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/synthesis/synthesis.h"
#include "codec/dec/group_decoder.h"
#include "codec/enc/fields/correction_encoder.h"
#include "codec/enc/fields/group_signal.h"
#include "codec/enc/motion/motion_fit.h"
#include "codec/enc/reference/surface_context.h"
#include "codec/enc/search/laplace_source.h"

namespace reeb {

/// One encoding of a group.
struct CodedGroup {
  double q = 0;
  float axis_step[3] = {1, 1, 1};  ///< of the motion model and, in the thesis profile, the residual
  uint32_t component_count = 0;
  uint32_t region_count = 0;
  bool weak_prior = false;  ///< as in the header
  std::vector<uint8_t> motion;
  std::vector<uint8_t> coefficients;
  std::vector<uint8_t> basis;
  std::optional<CodedCorrections> corrections;  ///< where there are any
  GroupSynthesis synthesis;                     ///< what the decoder will have
  double squared_error =
      0;  ///< over all vertices, frames and axes, but for the rounding to binary32
};

/// Where a group stands among groups that continue each other.
struct GroupRun {
  GroupState state;        ///< what the group before left; replaced by what this one leaves
  bool continues = false;  ///< this group starts from `state`
  bool continued = false;  ///< the next one will
};

/// Encodes one group at a given quantization step.
class GroupEncoder {
 public:
  explicit GroupEncoder(GroupSignal signal) : signal_(std::move(signal)) {}
  virtual ~GroupEncoder() = default;
  GroupEncoder(const GroupEncoder&) = delete;
  GroupEncoder& operator=(const GroupEncoder&) = delete;

  /// Encodes on a reference mesh with quantization step q > 0, world units. `motion` may be null.
  virtual CodedGroup encode(const SurfaceContext& surface, double q, const MotionFit* motion,
                            GroupRun& run) = 0;

  /// Bits and squared error to expect at quantization step q, roughly, without encoding.
  virtual RatePoint expect(const SurfaceContext& surface, double q) = 0;

  /// What the motion model is to predict: V x K, world units, rows as the surface graph.
  virtual Eigen::MatrixXf motion_targets(const SurfaceContext& surface) = 0;

  /// From now on sends exactly `count` components; nothing = as many as pay. Without a meaning in
  /// the thesis profile.
  void hold_components(std::optional<uint32_t> count) { held_count_ = count; }

  /// Lets weights go further from what distances tell. Without a meaning but in the main profile.
  void set_weak_prior(bool weak_prior) { weak_prior_ = weak_prior; }

  const GroupSignal& signal() const { return signal_; }

 protected:
  using Planes = std::vector<std::vector<float>>;

  GroupSignal signal_;
  std::optional<uint32_t> held_count_;
  bool weak_prior_ = false;
};

/// Fills the motion section and adds the motion to the planes.
void encode_motion(const SurfaceContext& surface, MotionModel& model, uint32_t stride,
                   CodedGroup& out, std::vector<std::vector<float>>& planes);

std::unique_ptr<GroupEncoder> make_group_encoder(GroupSignal signal, Profile profile,
                                                 unsigned threads);

}  // namespace reeb
