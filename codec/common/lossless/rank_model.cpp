#include "codec/common/lossless/rank_model.h"

namespace reeb {

namespace {

/// How far a size lies from the expected one, in half bits, of 16 classes.
uint32_t relative(int32_t size, const DifferenceContext& c) {
  return static_cast<uint32_t>(std::clamp((size - c.expected + 34) / 4, 0, 15));
}

}  // namespace

RankModel::RankModel() : mixer_(table_sizes(), kSteps * 3, kTableLimit) {}

std::array<uint32_t, RankModel::kTables> RankModel::table_sizes() {
  return {256 * 8 * kSteps, 256 * 8 * kSteps, 64 * 3 * kSteps,
          256 * kSteps,     256 * 8 * kSteps, 256 * kSteps};
}

std::array<uint32_t, RankModel::kTables> RankModel::entries(const DifferenceContext& c) {
  const auto phase = static_cast<uint32_t>(c.expected & 7);
  const auto absolute = static_cast<uint32_t>(std::clamp(c.expected, 0, 255));
  const std::array<uint32_t, kTables> context = {
      (relative(c.before, c) * 16 + relative(c.ring, c)) * 8 + phase,
      (relative(c.axis_before, c) * 16 + relative(c.before, c)) * 8 + phase,
      (c.coarseness * 8 + phase) * 3 + c.axis,
      absolute,
      (relative(c.ring, c) * 16 + relative(c.axis_before, c)) * 8 + phase,
      relative(c.older, c) * 16 + relative(c.nearest, c),
  };
  std::array<uint32_t, kTables> out;
  for (int i = 0; i < kTables; ++i) out[i] = context[i] * kSteps;
  return out;
}

}  // namespace reeb
