#include "codec/common/prediction/nearest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace reeb {

namespace {
constexpr uint32_t kNone = UINT32_MAX;
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

uint64_t EarlierNeighbours::Box::distance2(const int32_t* p) const {
  uint64_t sum = 0;
  for (int a = 0; a < 3; ++a) {
    const int64_t beyond =
        std::max({int64_t{least[a]} - p[a], int64_t{p[a]} - most[a], int64_t{0}});
    sum += static_cast<uint64_t>(beyond * beyond);
  }
  return sum;
}

void EarlierNeighbours::build() {
  items_.resize(points_.size());
  std::iota(items_.begin(), items_.end(), 0u);
  leaf_of_.resize(points_.size());
  build(0, points_.size(), 0);
}

EarlierNeighbours::Box EarlierNeighbours::bound(uint32_t begin, uint32_t end) const {
  Box box{begin, end, kNone, 0, {0, 0}, {0xFFFF, 0xFFFF, 0xFFFF}, {0, 0, 0}};
  for (uint32_t i = begin; i < end; ++i) {
    for (int a = 0; a < 3; ++a) {
      const auto x = static_cast<uint16_t>(points_[items_[i]][a]);
      box.least[a] = std::min(box.least[a], x);
      box.most[a] = std::max(box.most[a], x);
    }
  }
  return box;
}

uint32_t EarlierNeighbours::build(uint32_t begin, uint32_t end, uint32_t parent) {
  const auto id = static_cast<uint32_t>(boxes_.size());
  boxes_.push_back(bound(begin, end));
  boxes_[id].parent = parent;
  if (end - begin <= kLeafSize) {
    for (uint32_t i = begin; i < end; ++i) leaf_of_[items_[i]] = id;
    return id;
  }
  const auto extent = [&](int a) { return boxes_[id].most[a] - boxes_[id].least[a]; };
  int axis = 0;
  for (int a = 1; a < 3; ++a) axis = extent(a) > extent(axis) ? a : axis;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b);
                   });
  const uint32_t low = build(begin, middle, id);
  const uint32_t high = build(middle, end, id);
  boxes_[id].children[0] = low;
  boxes_[id].children[1] = high;
  return id;
}

void EarlierNeighbours::admit(uint32_t row) {
  for (; admitted_ < row; ++admitted_) {
    const uint32_t v = order_[admitted_];
    for (uint32_t box = leaf_of_[v]; boxes_[box].lowest > v; box = boxes_[box].parent) {
      boxes_[box].lowest = v;
    }
  }
}

void EarlierNeighbours::try_vertex(uint32_t u, Query& query) {
  ++work_;
  const Candidate c{points_.distance2(query.vertex, u), u};
  if (query.improves(c)) query.add(c);
}

void EarlierNeighbours::visit(uint32_t id, Query& query) {
  ++work_;
  const Box& box = boxes_[id];
  if (box.children[0] == 0) {
    for (uint32_t i = box.begin; i < box.end; ++i) {
      if (row_of_[items_[i]] < row_of_[query.vertex]) try_vertex(items_[i], query);
    }
    return;
  }
  // No vertex of a box is better than one at its nearest point with its lowest index.
  std::pair<Candidate, uint32_t> next[2];
  for (int i = 0; i < 2; ++i) {
    const Box& child = boxes_[box.children[i]];
    next[i] = {{child.distance2(points_[query.vertex]), child.lowest}, box.children[i]};
  }
  if (next[1] < next[0]) std::swap(next[0], next[1]);
  for (const auto& [bound, child] : next) {
    if (bound.second != kNone && query.improves(bound)) visit(child, query);
  }
}

std::vector<uint32_t> EarlierNeighbours::find(uint32_t v, uint32_t k) {
  Query query{v, k, {}};
  const bool spares_tree = boxes_.empty() && work_ <= kWorthATree * points_.size();
  if (row_of_[v] <= kFew || spares_tree) {
    for (uint32_t r = 0; r < row_of_[v]; ++r) try_vertex(order_[r], query);
  } else {
    if (boxes_.empty()) build();
    admit(row_of_[v]);
    visit(0, query);
  }
  std::vector<uint32_t> out;
  for (const Candidate& c : query.best) out.push_back(c.second);
  return out;
}

}  // namespace reeb
