#include "codec/common/vertex_order.h"

#include <algorithm>
#include <bit>

namespace reeb {
namespace {

// Bucket of a distance u = 0, 1, ...: 0, 1, then halves of octaves.
uint32_t bucket_of(uint64_t u) {
  if (u < 2) return static_cast<uint32_t>(u);
  const auto msb = static_cast<uint32_t>(std::bit_width(u)) - 1;
  return 2 * msb + static_cast<uint32_t>(u >> (msb - 1) & 1);
}

uint64_t bucket_start(uint32_t b) { return b < 2 ? b : (uint64_t{2} + (b & 1)) << (b / 2 - 1); }

uint64_t bucket_width_log2(uint32_t b) { return b < 4 ? 0 : b / 2 - 1; }

}  // namespace

FreeIndices::FreeIndices(uint32_t count) : tree_(size_t{count} + 1), count_(count) {
  for (uint32_t i = 1; i < tree_.size(); ++i) tree_[i] = i & (0 - i);
}

uint32_t FreeIndices::rank(uint32_t index) const {
  uint32_t sum = 0;
  for (uint32_t i = index; i > 0; i &= i - 1) sum += tree_[i];
  return sum;
}

uint32_t FreeIndices::select(uint32_t rank) const {
  uint32_t at = 0;
  for (auto step = static_cast<uint32_t>(std::bit_floor(tree_.size() - 1)); step > 0; step /= 2) {
    if (at + step < tree_.size() && tree_[at + step] <= rank) {
      at += step;
      rank -= tree_[at];
    }
  }
  return at;
}

void FreeIndices::take(uint32_t index) {
  for (uint64_t i = uint64_t{index} + 1; i < tree_.size(); i += i & (0 - i)) --tree_[i];
  --count_;
}

// Starts with near guesses a little likelier than far ones.
DistanceModel::DistanceModel() {
  for (auto& side : weight_) {
    for (uint32_t b = 0; b < kBuckets; ++b) side[b] = 1 + 64 / (b + 1);
  }
  seen_ = 4 * kUnit;
  sum_up();
}

void DistanceModel::sum_up() {
  for (size_t side = 0; side < 2; ++side) {
    uint64_t sum = 0;
    for (uint32_t b = 0; b < kBuckets; ++b) {
      inner_[side][b] = sum;
      sum += weight_[side][b];
    }
    total_[side] = sum;
  }
  scale_ = (uint64_t{1} << 30) / seen_;
}

uint64_t DistanceModel::below(int64_t rank, int64_t center) const {
  const bool lower = rank < center;
  const auto u = static_cast<uint64_t>(lower ? center - rank : rank - center);
  // Weight of the distances 0 .. u-1 on that side, with 12 bits of fraction.
  const uint32_t b = bucket_of(u);
  const uint64_t part =
      (u - bucket_start(b)) * (uint64_t{weight_[lower][b]} << 12) >> bucket_width_log2(b);
  const uint64_t near = (inner_[lower][b] << 12) + part;
  const uint64_t sum = lower ? (total_[1] << 12) - near : (total_[1] << 12) + near;
  return sum * scale_ >> 8;
}

void DistanceModel::observe(int64_t rank, int64_t center, uint32_t share) {
  constexpr uint32_t kMemory = 1u << 18;
  const bool lower = rank < center;
  const auto u = static_cast<uint64_t>(lower ? center - 1 - rank : rank - center);
  weight_[lower][bucket_of(u)] += share;
  seen_ += kUnit;
  if (seen_ > kMemory) {
    seen_ /= 2;
    for (auto& side : weight_) {
      for (uint32_t& w : side) w = w - w / 2;
    }
  }
  sum_up();
}

uint64_t IndexGuesses::weight(uint32_t first, uint32_t last) const {
  uint64_t sum = last - first;
  for (const Guess& g : guesses_) {
    sum += models_[g.kind].below(last, g.center) - models_[g.kind].below(first, g.center);
  }
  return sum;
}

void IndexGuesses::observe(uint32_t rank) {
  const uint64_t all = weight(rank, rank + 1);
  std::vector<uint64_t> own(guesses_.size());
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& g = guesses_[i];
    own[i] =
        models_[g.kind].below(int64_t{rank} + 1, g.center) - models_[g.kind].below(rank, g.center);
  }
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const auto share = static_cast<uint32_t>(own[i] * DistanceModel::kUnit / all);
    models_[guesses_[i].kind].observe(rank, guesses_[i].center, share);
  }
}

OrderPredictor::OrderPredictor(uint32_t vertex_count, std::span<const uint32_t> triangles)
    : vertex_count_(vertex_count),
      triangles_(triangles),
      twins_(pair_half_edges(triangles)),
      first_(size_t{vertex_count} + 1),
      around_(triangles.size()) {
  for (const uint32_t v : triangles) ++first_[v + 1];
  for (size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
  std::vector<uint32_t> at(first_.begin(), first_.end() - 1);
  for (uint32_t h = 0; h < triangles.size(); ++h) around_[at[triangles[h]]++] = h;
}

void OrderPredictor::guess(uint32_t v, const std::vector<uint32_t>& output_index,
                           const FreeIndices& free, IndexGuesses& out) {
  out.clear();
  neighbours_.clear();
  uint32_t kind = kParallelogram;
  for (uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
    const uint32_t across = next_half_edge(around_[i]);
    const uint32_t a = triangles_[across];
    const uint32_t b = triangles_[next_half_edge(across)];
    if (a < v) neighbours_.push_back(a);
    if (b < v) neighbours_.push_back(b);
    if (a >= v || b >= v || twins_[across] == kNoTwin) continue;
    const uint32_t c = triangles_[next_half_edge(next_half_edge(twins_[across]))];
    if (c >= v) continue;
    const int64_t index = int64_t{output_index[a]} + output_index[b] - output_index[c];
    if (index < 0 || index >= vertex_count_) continue;
    out.add(kind, free.rank(static_cast<uint32_t>(index)));
    kind = std::min<uint32_t>(kind + 1, kLastParallelogram);
  }
  if (v > 0) out.add(kPrevious, free.rank(output_index[v - 1]));
  guess_neighbours(output_index, free, out);
}

// The neighbours coded last are the best guesses.
void OrderPredictor::guess_neighbours(const std::vector<uint32_t>& output_index,
                                      const FreeIndices& free, IndexGuesses& out) {
  std::sort(neighbours_.rbegin(), neighbours_.rend());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  uint32_t kind = kNeighbour;
  for (const uint32_t n : neighbours_) {
    out.add(kind, free.rank(output_index[n]));
    kind = std::min<uint32_t>(kind + 1, kLastNeighbour);
  }
}

}  // namespace reeb
