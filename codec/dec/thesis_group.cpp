#include <utility>

#include "codec/common/motion/motion_model.h"
#include "codec/dec/field_decoder.h"
#include "codec/dec/group_parts.h"
#include "codec/dec/profile_groups.h"

namespace reeb {

namespace {

Status check_header(const GroupTask& task) {
  const GroupHeader& h = task.header();
  if (h.component_count != 3 * uint64_t{h.frame_count})
    return Status::corrupt("component_count does not fit the group's frames");
  if (Status s = check_motion(h); !s.ok()) return s;
  if (Status s = refuse_continuing(task.chunk); !s.ok()) return s;
  if (Status s = refuse_plain(task); !s.ok()) return s;
  if (h.weak_prior())
    return Status::corrupt("a group has weights of a weak prior, but does not start to learn any");
  if (h.basis_bytes > 0) return Status::corrupt("a section is there that the group does not use");
  return {};
}

}  // namespace

Status decode_thesis_group(const GroupTask& task, GroupSynthesis& out) {
  if (Status s = check_header(task); !s.ok()) return s;
  const GroupHeader& h = task.header();
  Field field(task.surface().graph, unpredicted_field_options(), task.threads);
  const bool whole = decode_field(task.chunk.coefficients, h.component_count, field, task.stop);
  if (Status s = section_status(whole, "coefficient", task.stop); !s.ok()) return s;
  Planes planes = field.take_planes();
  if (Status s = decode_motion(task, MotionModel::kFrameStride, planes); !s.ok()) return s;
  out = GroupSynthesis(std::move(planes), h.axis_step, task.decoded.origin, task.decoded.output);
  return decode_corrections(task, out);
}

}  // namespace reeb
