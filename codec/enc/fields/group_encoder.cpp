#include "codec/enc/fields/group_encoder.h"

#include "codec/common/motion/motion_syntax.h"
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

}  // namespace reeb
