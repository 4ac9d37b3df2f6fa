#include "codec/enc/fields/group_encoder.h"

#include "codec/common/motion/motion_syntax.h"
#include "codec/enc/fields/fast_encoder.h"
#include "codec/enc/fields/thesis_encoder.h"
#include "codec/enc/fields/transform_encoder.h"
#include "entropy/range_coder.h"

namespace reeb {

void encode_motion(const SurfaceContext& surface, MotionModel& model, uint32_t stride,
                   CodedGroup& out, std::vector<std::vector<float>>& planes) {
  BinaryEncoder encoder;
  model.code(encoder, surface.surface.graph, stride);
  out.region_count = model.regions();
  out.motion = encoder.finish();
  add_motion(model, planes);
}

std::unique_ptr<GroupEncoder> make_group_encoder(GroupSignal signal, Profile profile,
                                                 unsigned threads) {
  if (profile == Profile::kThesis)
    return std::make_unique<ThesisEncoder>(std::move(signal), threads);
  if (profile == Profile::kFast)
    return std::make_unique<FastEncoder>(std::move(signal), profile, threads);
  return std::make_unique<TransformEncoder>(std::move(signal), profile, threads);
}

}  // namespace reeb
