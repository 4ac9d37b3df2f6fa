#include "codec/common/reference/vertex_order.h"

#include <algorithm>
#include <bit>

#include "codec/common/mesh/connectivity.h"

namespace reeb {
// namespace

FreeIndices::FreeIndices(uint32_t count) : tree_(size_t{count} + 1), count_(count) {
  for (uint32_t i = 1; i < tree_.size(); ++i) tree_[i] = i & (0 - i);
}

uint32_t FreeIndices::rank(uint32_t index) const {
  uint32_t sum = 0;
  for (uint32_t i = index; i > 0; i &= i - 1) sum += tree_[i];
  return sum;
}

// Which way to go is hard to foresee, so there is no branch on it.
uint32_t FreeIndices::select(uint32_t rank) const {
  uint32_t at = 0;
  for (auto step = static_cast<uint32_t>(std::bit_floor(tree_.size() - 1)); step > 0; step /= 2) {
    if (at + step >= tree_.size()) continue;
    const uint32_t below = tree_[at + step];
    const uint32_t passed = below <= rank ? UINT32_MAX : 0;
    at += step & passed;
    rank -= below & passed;
  }
  return at;
}

void FreeIndices::take(uint32_t index) {
  for (uint64_t i = uint64_t{index} + 1; i < tree_.size(); i += i & (0 - i)) --tree_[i];
  --count_;
}

OrderPredictor::OrderPredictor(const TriangleTopology& topology)
    : topology_(topology), turn_of_(topology.point_count()) {
  for (uint32_t turn = 0; turn < turn_of_.size(); ++turn) turn_of_[topology.order[turn]] = turn;
}

void OrderPredictor::guess(uint32_t turn, const std::vector<uint32_t>& output_index,
                           const FreeIndices& free, GuessMixture& out) {
  out.clear();
  neighbours_.clear();
  const auto coded = [&](uint32_t v) { return turn_of_[v] < turn; };
  uint32_t kind = kParallelogram;
  for (const uint32_t h : topology_.fans[topology_.order[turn]]) {
    const uint32_t across = next_half_edge(h);
    const uint32_t a = topology_.triangles[across];
    const uint32_t b = topology_.triangles[next_half_edge(across)];
    if (coded(a)) neighbours_.push_back(turn_of_[a]);
    if (coded(b)) neighbours_.push_back(turn_of_[b]);
    if (!coded(a) || !coded(b) || topology_.twins[across] == kNoTwin) continue;
    const uint32_t c = topology_.triangles[next_half_edge(next_half_edge(topology_.twins[across]))];
    if (!coded(c)) continue;
    const int64_t index = int64_t{output_index[a]} + output_index[b] - output_index[c];
    if (index < 0 || index >= topology_.point_count()) continue;
    out.add(kind, int64_t{free.rank(static_cast<uint32_t>(index))} << 8, kScale);
    kind = std::min<uint32_t>(kind + 1, kLastParallelogram);
  }
  likely_ = turn > 0 ? free.rank(output_index[topology_.order[turn - 1]]) : 0;
  if (turn > 0) out.add(kPrevious, int64_t{likely_} << 8, kScale);
  guess_neighbours(output_index, free, out);
}

// The neighbours coded last are the best guesses.
void OrderPredictor::guess_neighbours(const std::vector<uint32_t>& output_index,
                                      const FreeIndices& free, GuessMixture& out) {
  std::sort(neighbours_.rbegin(), neighbours_.rend());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  uint32_t kind = kNeighbour;
  for (const uint32_t turn : neighbours_) {
    const uint32_t rank = free.rank(output_index[topology_.order[turn]]);
    if (kind == kNeighbour) likely_ = rank;
    out.add(kind, int64_t{rank} << 8, kScale);
    kind = std::min<uint32_t>(kind + 1, kLastNeighbour);
  }
}

}  // namespace reeb
