#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

namespace {

// 2^(-0.225 / 8) in units of 2^-30, and its powers, each rounded down.
constexpr uint64_t kStepRatio = 1053012196;

constexpr std::array<uint32_t, kStepLevels> make_step_table() {
  std::array<uint32_t, kStepLevels> table{};
  uint64_t power = 1u << 30;
  for (uint32_t i = 0; i < kStepLevels; ++i) {
    table[i] = static_cast<uint32_t>(power >> 14);
    power = power * kStepRatio >> 30;
  }
  return table;
}

}  // namespace

constexpr std::array<uint32_t, kStepLevels> kStepTable = make_step_table();

RowUses find_uses(const PredictionGraph& graph) {
  const uint32_t n = graph.size();
  RowUses out;
  out.begin.assign(n + 1, 0);
  for (const PredictionGraph::Row& row : graph.rows) {
    for (uint32_t i = 0; i < row.count; ++i) ++out.begin[row.neighbour[i] + 1];
  }
  for (uint32_t r = 0; r < n; ++r) out.begin[r + 1] += out.begin[r];
  out.to.resize(out.begin[n]);
  std::vector<uint32_t> next(out.begin.begin(), out.begin.end() - 1);
  for (uint32_t r = 0; r < n; ++r) {
    const PredictionGraph::Row& row = graph.rows[r];
    for (uint32_t i = 0; i < row.count; ++i)
      out.to[next[row.neighbour[i]]++] = 2 * r + (i < row.ring ? 1 : 0);
  }
  return out;
}

}  // namespace reeb
