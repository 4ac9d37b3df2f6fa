// Sites that mirror each other at a plane across an axis: most bodies have one.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/common/attributes/site_mesh.h"
#include "entropy/interval_coder.h"

namespace reeb {

struct MirrorPlane {
  uint32_t axis = 0;
  uint32_t sum = 0;  ///< of the coordinates of two points that mirror each other
};

/// Codes whether there is a plane, and which: complete with encoders, filled in with decoders.
template <class Coder>
void code_plane(Coder& coder, std::optional<MirrorPlane>& plane) {
  const auto code_bits = [&](uint32_t value, int count) {
    uint32_t out = 0;
    while (count-- > 0)
      out = out << 1 | (coder.code((value >> count & 1) != 0, kEvenOdds) ? 1u : 0u);
    return out;
  };
  constexpr int kAxisBits = 2, kSumBits = 17;
  const uint32_t kind = code_bits(plane ? plane->axis + 1 : 0, kAxisBits);
  plane = kind == 0
              ? std::nullopt
              : std::optional<MirrorPlane>({kind - 1, code_bits(plane ? plane->sum : 0, kSumBits)});
}

/// For the anchors of sites - vertices, or where there are none the sites themselves - the one
/// that mirrors each. Time O(n log n) on any input.
class MirrorSites {
 public:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  MirrorSites(const SiteMesh& sites, MirrorPlane plane);

  uint32_t anchor(uint32_t site) const {
    return sites_.vertex.empty() ? site : sites_.vertex[site];
  }
  /// The anchor that mirrors that of a site, or kNone.
  uint32_t partner(uint32_t site) const { return partner_[anchor(site)]; }
  /// The corners of a triangle that mirror three sites, in their order; false without one.
  bool find(const std::array<uint32_t, 3>& sites, std::array<uint32_t, 3>& mirrored) const;
  /// How many triangles have others that mirror them.
  size_t mirrored_triangles() const;

 private:
  using Cell = std::pair<uint64_t, uint32_t>;  ///< key, and the lowest site of an anchor
  struct Triangle {
    std::array<uint32_t, 3> anchors;  ///< sorted
    uint32_t first;                   ///< corner
  };
  void sort_cells();
  uint32_t nearest(const std::array<int64_t, 3>& point) const;
  void sort_triangles();

  const SiteMesh& sites_;
  int64_t low_[3] = {0, 0, 0};
  int64_t width_ = 1;
  std::vector<Cell> cells_;          // by key, then site
  std::vector<uint32_t> partner_;    // of each anchor
  std::vector<Triangle> triangles_;  // by anchors, then corner
};

}  // namespace reeb
