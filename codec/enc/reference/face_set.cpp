#include "codec/enc/reference/face_set.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "codec/common/mesh/faces.h"

namespace reeb {

FaceSet::FaceSet(const Connectivity& faces) : faces_(faces) {
  first_corner_.reserve(faces.face_sizes.size() + 1);
  first_corner_.push_back(0);
  for (const uint32_t size : faces.face_sizes) first_corner_.push_back(first_corner_.back() + size);
}

std::span<const uint32_t> FaceSet::corners(uint32_t face) const {
  return {faces_.corners.data() + first_corner_[face], faces_.face_sizes[face]};
}

std::vector<uint32_t> FaceSet::regular() const {
  std::vector<uint32_t> out;
  std::set<Cycle> seen;
  for (uint32_t f = 0; f < faces_.face_sizes.size(); ++f) {
    Cycle sorted(corners(f).begin(), corners(f).end());
    std::sort(sorted.begin(), sorted.end());
    const bool distinct = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    if (sorted.size() < 3 || !distinct) continue;
    if (seen.insert(canonical_cycle(corners(f))).second) out.push_back(f);
  }
  return out;
}

std::vector<uint32_t> FaceSet::owners(const std::vector<uint32_t>& faces,
                                      const PointTriangles& mesh,
                                      const std::vector<uint32_t>& vertex_of) const {
  std::multimap<Cycle, uint32_t> fans;
  for (const uint32_t f : faces) {
    const auto c = corners(f);
    for (size_t i = 1; i + 1 < c.size(); ++i) {
      fans.emplace(canonical_cycle(std::array{c[0], c[i], c[i + 1]}), f);
    }
  }
  std::vector<uint32_t> owner(mesh.triangles.size() / 3, std::numeric_limits<uint32_t>::max());
  for (size_t t = 0; t < owner.size(); ++t) {
    const uint32_t* p = &mesh.triangles[t * 3];
    const auto at =
        fans.find(canonical_cycle(std::array{vertex_of[p[0]], vertex_of[p[1]], vertex_of[p[2]]}));
    if (at == fans.end()) continue;
    owner[t] = at->second;
    fans.erase(at);
  }
  return owner;
}

std::vector<uint32_t> FaceSet::missing(const std::vector<uint32_t>& faces,
                                       const Polygons& found) const {
  std::multiset<Cycle> there;
  size_t corner = 0;
  for (const uint32_t size : found.sizes) {
    there.insert(canonical_cycle(std::span(found.corners).subspan(corner, size)));
    corner += size;
  }
  std::vector<uint32_t> out;
  for (const uint32_t f : faces) {
    const auto at = there.find(canonical_cycle(corners(f)));
    if (at == there.end()) {
      out.push_back(f);
    } else {
      there.erase(at);
    }
  }
  return there.empty() || !out.empty() ? out : faces;
}

}  // namespace reeb
