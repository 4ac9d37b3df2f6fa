#include "codec/enc/search/group_plan.h"

#include <algorithm>

#include "codec/enc/search/profile_tools.h"

namespace reeb {

namespace {

// A group of so many vertices times frames opens in about half a second.
constexpr uint64_t kGroupSamples = 8'000'000;
// Frames, unless asked for. Files play while they arrive; open groups of a hundred frames cost
// between 13 % more and 5 % less than one, closed ones up to 30 % more, so that these are longer.
constexpr uint32_t kShortestGroup = 16, kLongestOpen = 128, kLongestClosed = 256;
constexpr uint32_t kRunGroups = 4;  ///< that a seek decodes at most

uint32_t default_group_length(const Shot& shot, uint32_t longest) {
  const uint64_t by_time = kGroupSamples / shot.connectivity.vertex_count;
  return static_cast<uint32_t>(std::clamp<uint64_t>(by_time, kShortestGroup, longest));
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
  const bool open = options.open_groups != 0 && tools_of(options.profile).open_groups;
  GroupPlan plan;
  if (options.group_length > 0) {
    plan.lengths = split_by(shot.frame_count, options.group_length);
  } else {
    const uint32_t longest = open ? kLongestOpen : kLongestClosed;
    plan.lengths = split_evenly(shot.frame_count, default_group_length(shot, longest));
  }
  if (options.open_groups > 0) plan.open_groups = static_cast<uint32_t>(options.open_groups);
  if (options.open_groups < 0 && options.group_length == 0 && open)
    plan.open_groups = kRunGroups - 1;
  return plan;
}

}  // namespace reeb
