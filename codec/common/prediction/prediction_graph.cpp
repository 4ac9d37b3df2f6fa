#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

namespace {

// 2^(-0.225 / 8) in units of 2^-30, and its powers, each rounded down.
constexpr uint64_t kStepRatio = 1053012196;

constexpr std::array<uint32_t, kStepSizes> make_step_table() {
  std::array<uint32_t, kStepSizes> table{};
  uint64_t power = 1u << 30;
  for (uint32_t i = 0; i < kStepSizes; ++i) {
    table[i] = static_cast<uint32_t>(power >> 14);
    power = power * kStepRatio >> 30;
  }
  return table;
}

}  // namespace

constexpr std::array<uint32_t, kStepSizes> kStepTable = make_step_table();

RowUses find_uses(const PredictionGraph& graph) {
  return RowUses(graph.size(), [&](auto put) {
    for (uint32_t r = 0; r < graph.size(); ++r) {
      const PredictionGraph::Row& row = graph.rows[r];
      for (uint32_t i = 0; i < row.count; ++i)
        put(row.neighbour[i], 2 * r + (i < row.ring ? 1 : 0));
    }
  });
}

}  // namespace reeb
