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

/// Where the smallest rotation begins. Of two that agree in `same` corners and then differ, the
/// larger one is out, and so is every one that begins in what it agrees in: each step that ends an
/// agreement of n corners leaves n + 1 beginnings fewer, so the time is linear.
size_t least_rotation(std::span<const uint32_t> corners) {
  const size_t size = corners.size();
  size_t a = 0, b = 1;
  for (size_t same = 0; a < size && b < size && same < size;) {
    const uint32_t at_a = corners[(a + same) % size], at_b = corners[(b + same) % size];
    if (at_a == at_b) {
      ++same;
      continue;
    }
    (at_a > at_b ? a : b) += same + 1;
    if (a == b) ++b;
    same = 0;
  }
  return std::min(a, b);
}

}  // namespace

std::vector<uint32_t> canonical_cycle(std::span<const uint32_t> corners) {
  std::vector<uint32_t> out(corners.begin(), corners.end());
  std::rotate(out.begin(), out.begin() + static_cast<ptrdiff_t>(least_rotation(corners)),
              out.end());
  return out;
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
