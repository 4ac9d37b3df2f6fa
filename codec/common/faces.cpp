#include "codec/common/faces.h"

#include <algorithm>

namespace reeb {

namespace {

std::vector<std::vector<uint32_t>> sorted_cycles(const Connectivity& c) {
  std::vector<std::vector<uint32_t>> out;
  out.reserve(c.face_sizes.size());
  size_t corner = 0;
  for (const uint32_t size : c.face_sizes) {
    out.push_back(canonical_cycle(std::span(c.corners).subspan(corner, size)));
    corner += size;
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

// Rotations are only compared where the smallest corner occurs more than once.
std::vector<uint32_t> canonical_cycle(std::span<const uint32_t> corners) {
  const uint32_t lowest = *std::min_element(corners.begin(), corners.end());
  std::vector<uint32_t> best;
  for (size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] != lowest) continue;
    std::vector<uint32_t> cycle(corners.begin(), corners.end());
    std::rotate(cycle.begin(), cycle.begin() + static_cast<ptrdiff_t>(i), cycle.end());
    if (best.empty() || cycle < best) best = std::move(cycle);
  }
  return best;
}

bool same_faces(const Connectivity& a, const Connectivity& b) {
  if (a == b) return true;
  if (a.vertex_count != b.vertex_count || a.face_sizes.size() != b.face_sizes.size()) return false;
  return sorted_cycles(a) == sorted_cycles(b);
}

}  // namespace reeb
