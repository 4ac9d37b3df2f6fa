#include "codec/enc/search/group_plan.h"

#include <algorithm>

#include "codec/common/fields/field.h"
#include "codec/dec/group_memory.h"
#include "codec/enc/search/profile_tools.h"

namespace reeb {

namespace {

// A group of so many vertices times frames opens in about half a second.
constexpr uint64_t kGroupSamples = 8'000'000;
// Frames, unless asked for. Files play while they arrive; open groups of a hundred frames cost
// between 13 % more and 5 % less than one, closed ones up to 30 % more, so that these are longer.
constexpr uint32_t kShortestGroup = 16, kLongestOpen = 128, kLongestClosed = 256;
constexpr uint32_t kRunGroups = 4;  ///< that a seek decodes at most

// Frames of a closed group whose rows' learning a decoder need not keep.
constexpr uint32_t kSmallGroup = 5;
static_assert(!Field::keeps_equations(3 * kSmallGroup));

uint32_t default_group_length(const Shot& shot, uint32_t longest) {
  const uint64_t by_time = kGroupSamples / shot.connectivity.vertex_count;
  return static_cast<uint32_t>(
      std::min<uint64_t>(longest, std::max<uint64_t>(by_time, kShortestGroup)));
}

/// True where a decoder that keeps what rows learn would come near the memory that it is allowed
/// unless told otherwise; the shot takes its part of that, too.
bool learns_too_much(const Shot& shot, Profile profile) {
  GroupHeader h;
  h.frame_count = kShortestGroup;
  h.component_count = 3 * kShortestGroup;
  return profile == Profile::kMain &&
         group_memory(shot.connectivity.vertex_count, h, true) > Limits().max_memory * 3 / 4;
}

/// Lengths as equal as can be, none above `longest`.
std::vector<uint32_t> split_evenly(uint32_t frames, uint32_t longest) {
  const uint32_t parts = (frames + longest - 1) / longest;
  std::vector<uint32_t> lengths(parts, frames / parts);
  for (uint32_t i = 0; i < frames % parts; ++i) ++lengths[i];
  return lengths;
}

/// Groups of the length asked for, the last one shorter.
std::vector<uint32_t> split_by(uint32_t frames, uint32_t length) {
  std::vector<uint32_t> lengths(frames / length, length);
  if (frames % length != 0) lengths.push_back(frames % length);
  return lengths;
}

}  // namespace

GroupPlan plan_groups(const Shot& shot, const EncodeOptions& options) {
  const bool small = options.open_groups <= 0 && learns_too_much(shot, options.profile);
  const bool open = options.open_groups != 0 && tools_of(options.profile).open_groups && !small;
  GroupPlan plan;
  if (options.group_length > 0) {
    plan.lengths = split_by(shot.frame_count, options.group_length);
  } else {
    const uint32_t longest = small ? kSmallGroup : open ? kLongestOpen : kLongestClosed;
    plan.lengths = split_evenly(shot.frame_count, default_group_length(shot, longest));
  }
  if (options.open_groups > 0) plan.open_groups = static_cast<uint32_t>(options.open_groups);
  if (options.open_groups < 0 && options.group_length == 0 && open)
    plan.open_groups = kRunGroups - 1;
  return plan;
}

}  // namespace reeb
