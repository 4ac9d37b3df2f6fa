#include "codec/common/mesh/mesh_walk.h"

#include <algorithm>
#include <array>

#include "codec/common/base/item_lists.h"

namespace reeb {
namespace {

/// The corner of a triangle at a point: the corners behind it and before it.
struct Corner {
  uint32_t next, last;
};

/// The corners at every point, in the order of the triangles.
using CornerFans = ItemLists<Corner>;

CornerFans find_corners(uint32_t point_count, std::span<const uint32_t> triangles) {
  return CornerFans(point_count, [&](auto put) {
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      const uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
      put(a, {b, c});
      put(b, {c, a});
      put(c, {a, b});
    }
  });
}

/// Points waiting for their turn, by the number of their triangles that are known but for them.
class Waiting {
 public:
  explicit Waiting(uint32_t point_count) : count_(point_count) {}

  void raise(uint32_t point) {
    if (count_[point] == kQueues) return;
    queues_[count_[point]++].push_back(point);
  }

  /// The next point that had no turn, or kNoTurn when no triangle is known.
  uint32_t take(const std::vector<uint32_t>& turn_of) {
    for (uint32_t known = kQueues; known-- > 0;) {
      std::vector<uint32_t>& queue = queues_[known];
      size_t& at = heads_[known];
      while (at < queue.size()) {
        const uint32_t point = queue[at++];
        if (turn_of[point] == kNoTurn && count_[point] == known + 1) return point;
      }
      queue.clear();
      at = 0;
    }
    return kNoTurn;
  }

 private:
  static constexpr uint32_t kQueues = 6;
  std::vector<uint8_t> count_;
  std::array<std::vector<uint32_t>, kQueues> queues_;
  std::array<size_t, kQueues> heads_{};
};

/// Calls start(point) at each point's turn, then known(turn_of, a, b) for each of its triangles
/// whose other corners, a and b, had theirs.
template <class Start, class Known>
void walk(const CornerFans& fans, uint32_t point_count, Start start, Known known) {
  std::vector<uint32_t> turn_of(point_count, kNoTurn);
  Waiting waiting(point_count);
  uint32_t lowest = 0;
  for (uint32_t turn = 0; turn < point_count; ++turn) {
    uint32_t point = waiting.take(turn_of);
    while (point == kNoTurn && turn_of[lowest] != kNoTurn) ++lowest;
    if (point == kNoTurn) point = lowest;
    turn_of[point] = turn;
    start(point);
    for (const auto& [a, b] : fans[point]) {
      if (turn_of[a] != kNoTurn && turn_of[b] != kNoTurn) {
        known(turn_of, a, b);
      } else if (turn_of[a] != turn_of[b]) {
        waiting.raise(turn_of[a] != kNoTurn ? b : a);
      }
    }
  }
}

}  // namespace

std::vector<uint32_t> position_order(uint32_t point_count, std::span<const uint32_t> triangles) {
  std::vector<uint32_t> order;
  order.reserve(point_count);
  walk(
      find_corners(point_count, triangles), point_count,
      [&](uint32_t point) { order.push_back(point); }, [](const auto&, uint32_t, uint32_t) {});
  return order;
}

MeshWalk walk_mesh(uint32_t point_count, std::span<const uint32_t> triangles) {
  constexpr size_t kSearched = 16;  // corners of a point: a bound for meshes that are all one fan
  const CornerFans fans = find_corners(point_count, triangles);
  MeshWalk out;
  out.order.reserve(point_count);
  out.first.reserve(size_t{point_count} + 1);
  out.known.reserve(triangles.size() / 3);
  const auto start = [&](uint32_t point) {
    out.order.push_back(point);
    out.first.push_back(static_cast<uint32_t>(out.known.size()));
  };
  const auto known = [&](const std::vector<uint32_t>& turn_of, uint32_t a, uint32_t b) {
    if (out.known.size() - out.first.back() == MeshWalk::kMaxKnown) return;
    const std::span<const Corner> corners = fans[b];
    const auto end = corners.begin() + std::min(corners.size(), kSearched);
    const auto found =
        std::find_if(corners.begin(), end, [&](const Corner& c) { return c.next == a; });
    const uint32_t across = found == end ? kNoTurn : turn_of[found->last];
    const bool itself = across + 1 == out.order.size();
    out.known.push_back({turn_of[a], turn_of[b], itself ? kNoTurn : across});
  };
  walk(fans, point_count, start, known);
  out.first.push_back(static_cast<uint32_t>(out.known.size()));
  return out;
}

}  // namespace reeb
