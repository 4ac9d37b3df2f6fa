// Encoder of one group of frames at a given quantization step.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/common/base/stop.h"
#include "codec/common/fields/group_state.h"
#include "codec/common/synthesis/synthesis.h"
#include "codec/enc/fields/correction_encoder.h"
#include "codec/enc/fields/group_signal.h"
#include "codec/enc/motion/motion_fit.h"
#include "codec/enc/reference/surface_context.h"
#include "codec/enc/search/laplace_source.h"

namespace reeb {

/// How a group is coded.
struct GroupSettings {
  double q = 0;  ///< quantization step, > 0, world units
  /// Main profile: weights may go further from what distances tell; fast profile: they are wary.
  bool weak_prior = false;
  /// Sends exactly so many components; nothing = as many as pay. Without a meaning in the thesis
  /// profile.
  std::optional<uint32_t> components;
  StopToken stop = {};  ///< where it is requested, what comes out is of no use
};

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

/// A group's trajectories and how its profile codes them.
class GroupEncoder {
 public:
  explicit GroupEncoder(GroupSignal signal) : signal_(std::move(signal)) {}
  virtual ~GroupEncoder() = default;
  GroupEncoder(const GroupEncoder&) = delete;
  GroupEncoder& operator=(const GroupEncoder&) = delete;

  /// Encodes on a reference mesh. `motion` may be null.
  virtual CodedGroup encode(const SurfaceContext& surface, const GroupSettings& settings,
                            const MotionFit* motion, GroupRun& run) = 0;

  /// Bits and squared error to expect, roughly, without encoding.
  virtual RatePoint expect(const SurfaceContext& surface, const GroupSettings& settings) = 0;

  /// What the motion model is to predict: V x K, world units, rows as the surface graph.
  virtual Eigen::MatrixXf motion_targets(const SurfaceContext& surface) = 0;

  const GroupSignal& signal() const { return signal_; }

 protected:
  using Planes = std::vector<std::vector<float>>;

  GroupSignal signal_;
};

/// Fills the motion section and adds the motion to the planes.
void encode_motion(const SurfaceContext& surface, MotionModel& model, uint32_t stride,
                   CodedGroup& out, std::vector<std::vector<float>>& planes);

}  // namespace reeb
