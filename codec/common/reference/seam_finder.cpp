#include "codec/common/reference/seam_finder.h"

#include <algorithm>
#include <limits>

#include "codec/common/mesh/connectivity.h"

namespace reeb {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

}  // namespace

SeamFinder::SeamFinder(std::span<const uint32_t> triangles, std::span<const uint32_t> twins,
                       const HalfEdgeFans& fans, uint32_t point_count)
    : triangles_(triangles),
      twins_(twins),
      fans_(fans),
      on_boundary_(point_count),
      coded_(point_count),
      partner_(point_count, kNone) {
  for (uint32_t h = 0; h < twins.size(); ++h) {
    if (twins[h] == kNoTwin)
      on_boundary_[triangles[h]] = on_boundary_[triangles[next_half_edge(h)]] = 1;
  }
}

void SeamFinder::boundary_neighbours(uint32_t point, std::vector<uint32_t>& out) const {
  out.clear();
  if (on_boundary_[point] == 0) return;
  for (const uint32_t h : fans_[point]) {
    if (out.size() >= kMaxNeighbours) return;
    const uint32_t next = next_half_edge(h);
    const uint32_t before = next_half_edge(next);
    if (twins_[h] == kNoTwin) out.push_back(triangles_[next]);
    if (twins_[before] == kNoTwin) out.push_back(triangles_[before]);
  }
}

std::span<const uint32_t> SeamFinder::find(uint32_t point) {
  found_.clear();
  boundary_neighbours(point, near_);
  for (const uint32_t n : near_) {
    if (coded_[n] == 0 || partner_[n] == kNone) continue;
    boundary_neighbours(partner_[n], far_);
    for (const uint32_t c : far_) {
      if (found_.size() == kMaxFound) return found_;
      const bool known = std::find(found_.begin(), found_.end(), c) != found_.end();
      if (coded_[c] != 0 && !known) found_.push_back(c);
    }
  }
  return found_;
}

void SeamFinder::add(uint32_t point, std::span<const int32_t> xyz) {
  coded_[point] = 1;
  boundary_neighbours(point, near_);
  if (near_.empty()) return;
  uint64_t place = 0;
  for (const int32_t x : xyz) place = place << 16 | static_cast<uint64_t>(x);
  const auto [at, is_new] = latest_at_.try_emplace(place, point);
  if (is_new) return;
  partner_[point] = at->second;
  partner_[at->second] = point;
  at->second = point;
}

}  // namespace reeb
