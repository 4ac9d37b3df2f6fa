// Wedges: the corners around a vertex that share a value. A bit at either end of an edge tells
// whether the corners on its two sides do.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "codec/common/attributes/face_corners.h"
#include "entropy/adaptive_bit.h"

namespace reeb {

/// Numbered in the order of their lowest corners.
struct Wedges {
  std::vector<uint32_t> of_corner;
  std::vector<uint32_t> vertex;  ///< of each wedge

  uint32_t count() const { return static_cast<uint32_t>(vertex.size()); }
};

/// Sets of corners that joints connect.
class CornerSets {
 public:
  explicit CornerSets(uint32_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  uint32_t lowest(uint32_t c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }
  void join(uint32_t a, uint32_t b) {
    a = lowest(a);
    b = lowest(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

/// The wedges of sets of corners that each lie at one vertex.
Wedges number_wedges(const FaceCorners& corners, CornerSets& sets);

/// Calls visit(a, b, at_start) for every joint: corners a and b of one vertex, on the two sides of
/// an edge, at the edge's start and at its end, edge after edge.
template <class Visit>
void for_each_joint(const FaceCorners& corners, Visit visit) {
  for (uint32_t c = 0; c < corners.count(); ++c) {
    const uint32_t t = corners.twin[c];
    if (t == kNoTwin || t < c) continue;
    visit(c, corners.next(t), true);
    visit(corners.next(c), t, false);
  }
}

/// Which joints are seams. Around an inner vertex there are none or at least two, so that the last
/// one may need no bit.
class SeamSyntax {
 public:
  explicit SeamSyntax(const FaceCorners& corners);

  /// `seam(a, b)` tells an encoder whether two corners differ.
  template <class Coder, class Seam>
  Wedges code(Coder& coder, Seam seam) {
    CornerSets sets(corners_.count());
    bool before = false;
    for_each_joint(corners_, [&](uint32_t a, uint32_t b, bool at_start) {
      Fan& fan = fans_[fan_of_[a]];
      const bool bit = code_joint(coder, fan, at_start ? 0 : before ? 2 : 1, seam, a, b);
      --fan.joints_left;
      fan.seams += bit ? 1 : 0;
      if (!bit) sets.join(a, b);
      before = bit;
    });
    return number_wedges(corners_, sets);
  }

 private:
  /// The corners of a vertex that joints connect.
  struct Fan {
    uint32_t corners = 0, joints = 0;
    uint32_t joints_left = 0, seams = 0;
    bool closed() const { return joints == corners; }
  };

  template <class Coder, class Seam>
  bool code_joint(Coder& coder, const Fan& fan, uint32_t other_end, Seam seam, uint32_t a,
                  uint32_t b) {
    const bool last = fan.closed() && fan.joints_left == 1;
    if (last && fan.seams < 2) return fan.seams == 1;
    const uint32_t left = fan.closed() ? std::min(fan.joints_left, 4u) - 1 : 4;
    return models_[std::min(fan.seams, 2u)][left][other_end].code(coder, seam(a, b));
  }

  const FaceCorners& corners_;
  std::vector<uint32_t> fan_of_;  ///< of each corner
  std::vector<Fan> fans_;         ///< by their lowest corners
  std::array<std::array<std::array<AdaptiveBit, 3>, 5>, 3> models_;
};

}  // namespace reeb
