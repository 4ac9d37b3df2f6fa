// What the other half of a body tells of an attribute's integers.
//
// Floating point as in value_predictor.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/common/attributes/mirror_sites.h"
#include "codec/common/mesh/mesh_walk.h"

namespace reeb {

/// Used for each site in the order of the walk: `start`, then `learn` for each channel.
class MirrorGuess {
 public:
  /// `planar`: the first two channels are coordinates on a plane. Without `plane` there is never a
  /// guess.
  MirrorGuess(const SiteMesh& sites, const MeshWalk& walk, size_t channels, bool planar,
              const std::optional<MirrorPlane>& plane);

  /// `values`: [site][channel], of which those coded before are read.
  void start(uint32_t turn, std::span<const uint32_t> values);
  void learn(size_t channel, uint32_t value);

  /// A site whose values may come again, or MirrorSites::kNone.
  uint32_t same() const { return same_; }
  bool missed() const { return missed_; }  ///< it has: a channel so far is another
  bool has_triangle() const { return has_triangle_; }
  /// Where a triangle there is moved to; with one only.
  double moved(size_t channel) const { return moved_[channel]; }
  /// How far that may be off.
  double scale(size_t channel) const;

 private:
  using Sites = std::array<uint32_t, 3>;  ///< two corners of an edge, and the one they lead to

  double value(uint32_t site, size_t channel) const { return values_[site * channels_ + channel]; }
  bool is_known(const Sites& sites) const;
  bool move(const Sites& from, const Sites& to);
  bool turn_over(const Sites& from, const Sites& to);
  void finish();

  std::optional<MirrorSites> pairs_;
  const MeshWalk& walk_;
  const size_t channels_;
  const bool planar_;
  std::vector<uint32_t> turn_;    // of each site
  std::vector<uint32_t> latest_;  // of each anchor, the site coded last
  double error_ = 8;              // of the triangles lately
  int turning_ = -1;              // above 0 where charts are moved, not turned over

  // Of the site at hand.
  std::span<const uint32_t> values_;
  uint32_t site_ = 0, same_ = MirrorSites::kNone;
  bool missed_ = false, has_triangle_ = false;
  Sites own_ = {};
  double beside_ = 0;  // where the corner there is, off its edge, on the plane
  std::vector<double> moved_;
  double last_error_ = 0, error_sum_ = 0;
};

}  // namespace reeb
