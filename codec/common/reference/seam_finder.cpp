#include "codec/common/reference/seam_finder.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "codec/common/mesh/connectivity.h"

namespace reeb {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

/// Neighbours of a point after which no more are looked for.
constexpr uint32_t kEnough = 16;

ItemLists<uint32_t> boundary_neighbours(std::span<const uint32_t> triangles,
                                        std::span<const uint32_t> twins, const HalfEdgeFans& fans) {
  return ItemLists<uint32_t>(fans.vertex_count(), [&](auto put) {
    for (uint32_t point = 0; point < fans.vertex_count(); ++point) {
      uint32_t count = 0;
      for (const uint32_t h : fans[point]) {
        if (count >= kEnough) break;
        const uint32_t next = next_half_edge(h);
        const uint32_t before = next_half_edge(next);
        for (const auto& [edge, end] : {std::pair(h, next), std::pair(before, before)}) {
          if (twins[edge] != kNoTwin) continue;
          put(point, triangles[end]);
          ++count;
        }
      }
    }
  });
}

}  // namespace

SeamFinder::SeamFinder(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
                       const HalfEdgeFans& fans, uint32_t point_count)
    : near_(boundary_neighbours(triangles, twins, fans)),
      coded_(point_count),
      partner_(point_count, kNone) {}

std::span<const uint32_t> SeamFinder::find(uint32_t point) {
  found_.clear();
  for (const uint32_t n : near_[point]) {
    if (coded_[n] == 0 || partner_[n] == kNone) continue;
    for (const uint32_t c : near_[partner_[n]]) {
      if (found_.size() == kMaxFound) return found_;
      const bool known = std::find(found_.begin(), found_.end(), c) != found_.end();
      if (coded_[c] != 0 && !known) found_.push_back(c);
    }
  }
  return found_;
}

void SeamFinder::add(uint32_t point, std::span<const int32_t> xyz) {
  coded_[point] = 1;
  if (near_[point].empty()) return;
  uint64_t place = 0;
  for (const int32_t x : xyz) place = place << 16 | static_cast<uint64_t>(x);
  const auto [at, is_new] = latest_at_.try_emplace(place, point);
  if (is_new) return;
  partner_[point] = at->second;
  partner_[at->second] = point;
  at->second = point;
}

}  // namespace reeb
