#include "codec/dec/group_decoder.h"

#include "bitstream/element_bound.h"
#include "codec/dec/profile_groups.h"

namespace reeb {

namespace {

Status decode_group_of_profile(const GroupTask& task, GroupSynthesis& out) {
  switch (task.header().profile) {
    case Profile::kMain:
      return decode_main_group(task, out);
    case Profile::kFast:
      return decode_fast_group(task, out);
    case Profile::kThesis:
      return decode_thesis_group(task, out);
    case Profile::kLossless:
      return decode_lossless_group(task, out);
  }
  return Status::corrupt("the group is of no profile");
}

}  // namespace

Status check_elements(const GroupHeader& header, uint64_t vertices) {
  return within_element_bound(header, vertices)
             ? Status()
             : Status::corrupt("a group announces more than its bytes can hold");
}

Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    bool keep, GroupState& state, GroupSynthesis& out, const StopToken& stop) {
  if (Status s = check_elements(chunk.header, surface.output.size()); !s.ok()) return s;
  GroupState before = std::exchange(state, GroupState());
  const GroupTask task = {chunk, surface, threads, before, keep ? &state : nullptr, stop};
  return decode_group_of_profile(task, out);
}

}  // namespace reeb
