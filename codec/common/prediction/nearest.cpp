#include "codec/common/prediction/nearest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace reeb {

namespace {
constexpr uint32_t kLeafSize = 8;
constexpr uint32_t kFew = 128;  ///< earlier vertices that are all tried
/// Vertices that may be tried for each of the tree before that is made: about what it takes.
constexpr uint64_t kWorthATree = 16;
using Candidate = std::pair<uint64_t, uint32_t>;  // squared distance, vertex
}  // namespace

struct EarlierNeighbours::Query {
  uint32_t vertex;
  uint32_t k;
  std::vector<Candidate> best;  ///< sorted, at most k

  bool improves(const Candidate& c) const { return best.size() < k || c < best.back(); }
  void add(const Candidate& c) {
    if (best.size() == k) best.pop_back();
    best.insert(std::lower_bound(best.begin(), best.end(), c), c);
  }
};

void EarlierNeighbours::build() {
  items_.resize(points_.size());
  std::iota(items_.begin(), items_.end(), 0u);
  build(0, points_.size());
}

uint32_t EarlierNeighbours::build(uint32_t begin, uint32_t end) {
  const auto id = static_cast<uint32_t>(nodes_.size());
  Node node{begin, end, UINT32_MAX, 0, 0, 0, 0};
  int32_t low[3] = {INT32_MAX, INT32_MAX, INT32_MAX};
  int32_t high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
  for (uint32_t i = begin; i < end; ++i) {
    node.min_rank = std::min(node.min_rank, rank_[items_[i]]);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], points_[items_[i]][a]);
      high[a] = std::max(high[a], points_[items_[i]][a]);
    }
  }
  for (int a = 1; a < 3; ++a) {
    if (high[a] - low[a] > high[node.axis] - low[node.axis]) node.axis = a;
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return id;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     return std::pair(points_[a][node.axis], a) <
                            std::pair(points_[b][node.axis], b);
                   });
  const int32_t split = points_[items_[middle]][node.axis];
  const uint32_t left = build(begin, middle);
  const uint32_t right = build(middle, end);
  nodes_[id].left = left;
  nodes_[id].right = right;
  nodes_[id].split = split;
  return id;
}

void EarlierNeighbours::try_vertex(uint32_t u, Query& query) const {
  const Candidate c{points_.distance2(query.vertex, u), u};
  if (query.improves(c)) query.add(c);
}

void EarlierNeighbours::visit(uint32_t id, Query& query) const {
  const Node& node = nodes_[id];
  if (node.min_rank >= rank_[query.vertex]) return;
  if (node.left == 0) {
    for (uint32_t i = node.begin; i < node.end; ++i) {
      if (rank_[items_[i]] < rank_[query.vertex]) try_vertex(items_[i], query);
    }
    return;
  }
  const int64_t offset = int64_t{points_[query.vertex][node.axis]} - node.split;
  visit(offset < 0 ? node.left : node.right, query);
  const auto gap = static_cast<uint64_t>(offset * offset);
  if (query.best.size() < query.k || gap <= query.best.back().first) {
    visit(offset < 0 ? node.right : node.left, query);
  }
}

std::vector<uint32_t> EarlierNeighbours::find(uint32_t v, uint32_t k) {
  Query query{v, k, {}};
  const bool spares_tree = nodes_.empty() && tried_ <= kWorthATree * points_.size();
  if (rank_[v] <= kFew || spares_tree) {
    tried_ += rank_[v];
    for (uint32_t r = 0; r < rank_[v]; ++r) try_vertex(order_[r], query);
  } else {
    if (nodes_.empty()) build();
    visit(0, query);
  }
  std::vector<uint32_t> out;
  for (const Candidate& c : query.best) out.push_back(c.second);
  return out;
}

}  // namespace reeb
