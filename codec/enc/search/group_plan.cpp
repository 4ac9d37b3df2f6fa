#include "codec/enc/search/group_plan.h"

#include <algorithm>

namespace reeb {

namespace {

constexpr uint32_t kLongestGroup = 512;  ///< frames, unless asked for
constexpr uint64_t kGroupSamples =
    100'000'000;  ///< vertices times frames, to bound the encoder's memory

uint32_t default_group_length(const Shot& shot) {
  const uint64_t by_memory = std::max<uint64_t>(1, kGroupSamples / shot.connectivity.vertex_count);
  return static_cast<uint32_t>(std::min<uint64_t>(kLongestGroup, by_memory));
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

std::vector<uint32_t> plan_groups(const Shot& shot, const EncodeOptions& options) {
  return options.group_length > 0 ? split_by(shot.frame_count, options.group_length)
                                  : split_evenly(shot.frame_count, default_group_length(shot));
}

}  // namespace reeb
