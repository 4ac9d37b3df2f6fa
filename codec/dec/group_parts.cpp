#include "codec/dec/group_parts.h"

#include <cmath>
#include <string>
#include <utility>

#include "codec/common/motion/motion_syntax.h"
#include "codec/common/synthesis/correction_field.h"
#include "entropy/range_coder.h"

namespace reeb {

Status check_components(const GroupHeader& h) {
  return h.component_count <= 3 * uint64_t{h.frame_count}
             ? Status()
             : Status::corrupt("component_count does not fit the group's frames");
}

Status check_motion(const GroupHeader& h) {
  if (h.region_count > MotionModel::kMaxRegions)
    return Status::corrupt("region_count is out of range");
  if (h.region_count == 0 && h.motion_bytes > 0)
    return Status::corrupt("a section is there that the group does not use");
  return {};
}

Status refuse_continuing(const GroupChunk& chunk) {
  return chunk.continues()
             ? Status::corrupt("a group continues another in a profile where none does")
             : Status();
}

Status refuse_plain(const GroupTask& task) {
  return task.surface().plain
             ? Status::corrupt("the group's profile does not fit its reference mesh")
             : Status();
}

Status section_status(bool whole, const char* section, const StopToken& stop) {
  if (stop.requested()) return Status::cancelled();
  return whole ? Status() : Status::corrupt("the " + std::string(section) + " section is damaged");
}

Status decode_motion(const GroupTask& task, uint32_t stride, Planes& planes) {
  const GroupHeader& h = task.header();
  if (h.region_count == 0) return {};
  BinaryDecoder decoder(task.chunk.motion);
  MotionModel motion(h.region_count, h.component_count);
  if (!motion.code(decoder, task.surface().graph, stride) || decoder.overrun())
    return Status::corrupt("the motion section is damaged");
  motion.locate(task.surface().points(), task.surface().order);
  add_motion(motion, planes);
  return {};
}

GroupSynthesis join_fields(const GroupTask& task, Planes planes, const Planes& basis,
                           const std::vector<uint32_t>& order) {
  const auto q = static_cast<double>(task.header().quantization_step);
  return synthesize(std::move(planes), basis, order, q, task.decoded.origin, task.decoded.output);
}

Status decode_corrections(const GroupTask& task, GroupSynthesis& out) {
  const GroupHeader& h = task.header();
  if (h.correction_count > 0) {
    if (h.correction_count > Corrections::kMaxCount)
      return Status::limit("more corrections than a decoder takes");
    Corrections corrections(h.frame_count, h.correction_step, h.correction_count);
    CorrectionField field(task.surface().graph, h.frame_count, h.correction_count);
    BinaryDecoder decoder(task.chunk.corrections);
    uint64_t count = 0;
    const bool in_range = field.code(
        decoder, [](uint32_t, uint32_t, uint32_t) { return Correction(); },
        [&](uint32_t row, uint32_t t, uint32_t axis, const Correction& c) {
          task.stop.check();
          if (!std::isfinite(c.value) || ++count > h.correction_count || decoder.overrun())
            return false;
          corrections.add(task.decoded.output[row], t, axis, c);
          return true;
        });
    if (!in_range || count != h.correction_count || decoder.overrun())
      return Status::corrupt("the correction section is damaged");
    out.set_corrections(std::move(corrections));
  }
  return out.finite() ? Status() : Status::corrupt("the group's basis is out of range");
}

}  // namespace reeb
