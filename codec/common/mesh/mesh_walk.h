// The order in which the points of a mesh are coded, along its triangles, and what is known around
// each of them when its turn comes.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace reeb {

/// Order of coding: always a point with the most triangles known but for it, up to six; among
/// those the one that reached that number first; without any, the lowest. Sees only triangles.
std::vector<uint32_t> position_order(uint32_t point_count, std::span<const uint32_t> triangles);

inline constexpr uint32_t kNoTurn = std::numeric_limits<uint32_t>::max();

/// A triangle of a point, whose two other corners had their turns before: these turns. `across` is
/// that of the third corner of the triangle beyond their edge, kNoTurn where there is none yet.
struct KnownTriangle {
  uint32_t a, b, across;
};

struct MeshWalk {
  std::vector<uint32_t> order;       ///< the point of each turn, as of `position_order`
  std::vector<uint32_t> first;       ///< of each turn, its first in `known`; one more at the end
  std::vector<KnownTriangle> known;  ///< at most kMaxKnown a turn

  static constexpr uint32_t kMaxKnown = 16;

  uint32_t turns() const { return static_cast<uint32_t>(order.size()); }
  std::span<const KnownTriangle> triangles(uint32_t turn) const {
    return std::span(known).subspan(first[turn], first[turn + 1] - first[turn]);
  }
};

/// `triangles`: three points below `point_count` each, all different; any topology. Time O(points +
/// triangles).
MeshWalk walk_mesh(uint32_t point_count, std::span<const uint32_t> triangles);

}  // namespace reeb
