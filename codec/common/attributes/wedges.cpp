#include "codec/common/attributes/wedges.h"

namespace reeb {

Wedges number_wedges(const FaceCorners& corners, CornerSets& sets) {
  Wedges out;
  out.of_corner.reserve(corners.count());
  for (uint32_t c = 0; c < corners.count(); ++c) {
    const uint32_t lowest = sets.lowest(c);
    if (lowest == c) {
      out.of_corner.push_back(out.count());
      out.vertex.push_back(corners.vertex[c]);
    } else {
      out.of_corner.push_back(out.of_corner[lowest]);
    }
  }
  return out;
}

SeamSyntax::SeamSyntax(const FaceCorners& corners)
    : corners_(corners), fan_of_(corners.count()), fans_(corners.count()) {
  CornerSets sets(corners.count());
  for_each_joint(corners, [&](uint32_t a, uint32_t b, bool) { sets.join(a, b); });
  for (uint32_t c = 0; c < corners.count(); ++c) ++fans_[fan_of_[c] = sets.lowest(c)].corners;
  for_each_joint(corners, [&](uint32_t a, uint32_t, bool) { ++fans_[fan_of_[a]].joints; });
  for (Fan& fan : fans_) fan.joints_left = fan.joints;
}

}  // namespace reeb
