#include "codec/common/mesh/faces.h"

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

size_t fan_triangles(std::span<const uint32_t> face_sizes, std::span<const uint32_t> corners,
                     uint32_t* out) {
  size_t count = 0;
  const uint32_t* face = corners.data();
  for (const uint32_t size : face_sizes) {
    for (uint32_t i = 2; i < size; ++i, count += 3) {
      if (out == nullptr) continue;
      out[count] = face[0];
      out[count + 1] = face[i - 1];
      out[count + 2] = face[i];
    }
    face += size;
  }
  return count;
}

std::vector<uint32_t> fan_triangles(const Connectivity& c) {
  std::vector<uint32_t> out(fan_triangles(c.face_sizes, c.corners, nullptr));
  fan_triangles(c.face_sizes, c.corners, out.data());
  return out;
}

}  // namespace reeb
