#include "conformance/rd/peers/traversal.h"

#include <algorithm>
#include <deque>

#include "codec/common/mesh/half_edge_fans.h"

namespace reeb::conformance {
namespace {

constexpr uint32_t kNone = 0xFFFFFFFF;

class Traverser {
 public:
  Traverser(std::span<const uint32_t> triangles, uint32_t vertex_count)
      : triangles_(triangles),
        fans_(vertex_count, triangles),
        rank_(vertex_count, kNone),
        seen_(triangles.size() / 3, false) {}

  Traversal run() {
    for (uint32_t t = 0; t < seen_.size(); ++t) visit_component(t);
    for (uint32_t v = 0; v < rank_.size(); ++v) place(v);
    out_.parallelogram_begin.push_back(static_cast<uint32_t>(out_.parallelograms.size()));
    out_.neighbour_begin.push_back(static_cast<uint32_t>(out_.neighbours.size()));
    return std::move(out_);
  }

 private:
  uint32_t corner(uint32_t t, uint32_t i) const { return triangles_[size_t{t} * 3 + i % 3]; }

  void visit_component(uint32_t first) {
    if (seen_[first]) return;
    seen_[first] = true;
    std::deque<uint32_t> queue{first};
    while (!queue.empty()) {
      const uint32_t t = queue.front();
      queue.pop_front();
      for (uint32_t i = 0; i < 3; ++i) place(corner(t, i));
      for (uint32_t i = 0; i < 3; ++i) {
        for (const uint32_t h : fans_[corner(t, i)]) push_if_adjacent(t, h / 3, queue);
      }
    }
  }

  /// Queues `other` where it shares an edge with t.
  void push_if_adjacent(uint32_t t, uint32_t other, std::deque<uint32_t>& queue) {
    if (seen_[other]) return;
    uint32_t shared = 0;
    for (uint32_t i = 0; i < 9; ++i) shared += corner(t, i / 3) == corner(other, i % 3) ? 1 : 0;
    if (shared < 2) return;
    seen_[other] = true;
    queue.push_back(other);
  }

  void place(uint32_t v) {
    if (rank_[v] != kNone) return;
    out_.parallelogram_begin.push_back(static_cast<uint32_t>(out_.parallelograms.size()));
    out_.neighbour_begin.push_back(static_cast<uint32_t>(out_.neighbours.size()));
    for (const uint32_t h : fans_[v]) {
      const uint32_t a = corner(h / 3, h % 3 + 1);
      const uint32_t b = corner(h / 3, h % 3 + 2);
      for (const uint32_t n : {a, b}) add_neighbour(n);
      if (rank_[a] != kNone && rank_[b] != kNone) add_parallelograms(a, b, v);
    }
    rank_[v] = static_cast<uint32_t>(out_.order.size());
    out_.order.push_back(v);
  }

  void add_neighbour(uint32_t n) {
    const auto begin = out_.neighbours.begin() + out_.neighbour_begin.back();
    if (rank_[n] != kNone && std::find(begin, out_.neighbours.end(), n) == out_.neighbours.end())
      out_.neighbours.push_back(n);
  }

  /// Over the edge a-b, from all triangles on its other side.
  void add_parallelograms(uint32_t a, uint32_t b, uint32_t v) {
    for (const uint32_t h : fans_[a]) {
      const uint32_t p = corner(h / 3, h % 3 + 1);
      const uint32_t q = corner(h / 3, h % 3 + 2);
      const uint32_t c = p == b ? q : p;
      if ((p == b || q == b) && c != v && rank_[c] != kNone)
        out_.parallelograms.push_back({a, b, c});
    }
  }

  std::span<const uint32_t> triangles_;
  HalfEdgeFans fans_;
  std::vector<uint32_t> rank_;  ///< place in the order, kNone before it has one
  std::vector<bool> seen_;      ///< triangles
  Traversal out_;
};

}  // namespace

Traversal traverse(std::span<const uint32_t> triangles, uint32_t vertex_count) {
  return Traverser(triangles, vertex_count).run();
}

}  // namespace reeb::conformance
