#include "codec/enc/reference/face_matching.h"

#include <map>

#include "codec/common/mesh/faces.h"

namespace reeb {

namespace {

/// Where `turned` starts in `corners`, of which it is a rotation.
uint32_t rotation_of(std::span<const uint32_t> corners, std::span<const uint32_t> turned) {
  const auto size = static_cast<uint32_t>(corners.size());
  for (uint32_t first = 0; first < size; ++first) {
    uint32_t i = 0;
    while (i < size && corners[(first + i) % size] == turned[i]) ++i;
    if (i == size) return first;
  }
  return 0;
}

}  // namespace

FaceOrder match_faces(const Connectivity& faces, const Connectivity& input) {
  const FaceOrderContext from(faces);
  const FaceOrderContext to(input);
  std::multimap<std::vector<uint32_t>, uint32_t> places;  // equal ones stay in order
  for (uint32_t f = 0; f < to.count(); ++f) places.emplace(canonical_cycle(to.corners(f)), f);
  FaceOrder out;
  for (uint32_t f = 0; f < from.count(); ++f) {
    const auto at = places.find(canonical_cycle(from.corners(f)));
    if (at == places.end()) break;  // not the same faces; the caller finds the order too short
    out.index.push_back(at->second);
    out.first.push_back(rotation_of(from.corners(f), to.corners(at->second)));
    places.erase(at);
  }
  return out;
}

}  // namespace reeb
