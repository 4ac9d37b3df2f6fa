#include "codec/dec/group_decoder.h"

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

Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    bool keep, GroupState& state, GroupSynthesis& out, const StopToken& stop) {
  GroupState before = std::exchange(state, GroupState());
  const GroupTask task = {chunk, surface, threads, before, keep ? &state : nullptr, stop};
  return decode_group_of_profile(task, out);
}

}  // namespace reeb
