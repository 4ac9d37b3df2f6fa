// Guesses of an attribute's integers at a site from those of the sites before.
//
// Floating point is binary64 without contraction, in the order written, so that every machine makes
// the same guesses.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "codec/common/attributes/mirror_guess.h"
#include "codec/common/attributes/site_mesh.h"
#include "codec/common/base/fixed_list.h"
#include "codec/common/mesh/mesh_walk.h"
#include "codec/common/reference/guess_mixture.h"
#include "codec/common/reference/point_predictor.h"

namespace reeb {

/// Used for each site in the order of the walk: `start`, then for each channel `guess` and `learn`.
class ValuePredictor {
 public:
  static constexpr uint32_t kMemory = 256;  ///< observations, see GuessMixture
  static constexpr uint32_t kSituations = 5;
  static constexpr uint32_t kKindCount = 12 * kSituations;

  /// `sites` and `walk` must outlive the predictor. `tops`: largest integer of each channel.
  /// `texture`: the first two channels are coordinates on a plane. `plane`: one that the sites
  /// mirror each other at.
  ValuePredictor(const SiteMesh& sites, const MeshWalk& walk, std::vector<uint32_t> tops,
                 bool texture, const std::optional<MirrorPlane>& plane);

  /// `values`: [site][channel], of which those coded before are read.
  void start(uint32_t turn, std::span<const uint32_t> values);
  void guess(size_t channel, GuessMixture& out) const;
  void learn(size_t channel, uint32_t value);
  /// The one guess where there is to be one, and where to look first.
  uint32_t likely(size_t channel) const;
  /// How far it may be off.
  double scale(size_t channel) const;
  uint32_t reach(size_t channel) const;

 private:
  /// A known triangle in the plane of its own, with the edge from a to b as unit: where the site
  /// lies along it and beside it, and the same of the corner across.
  struct Unfolded {
    uint32_t a, b, across;  ///< sites
    double along = 0, beside = 0;
    double across_along = 0, across_beside = 0;
    bool flat = false;  ///< a and b are at one place
  };
  struct Channel {
    double tips = 0, squares = 0, mean = 0, affine = 0, conformal = 0;  // sums, then means
    double base = 0, fitted = 0, spread = 0;
    FeatureWeights::Row features = {};
  };
  /// A site whose value may come again.
  struct Candidate {
    uint32_t site;
    bool sibling;  ///< of the same vertex
    bool missed;   ///< one of the channels so far is another
  };

  uint32_t value(uint32_t site, size_t channel) const {
    return values_[site * channels_.size() + channel];
  }
  Unfolded unfold(const KnownTriangle& triangle) const;
  void add(const Unfolded& triangle);
  void add_conformal(const Unfolded& triangle);
  double turning_of(const Unfolded& triangle) const;
  void add_candidate(uint32_t site, bool sibling);
  void find_candidates();
  void guess_mirrored(size_t channel, GuessMixture& out) const;
  uint32_t situation() const;  ///< what is known around the site
  void set_base(Channel& channel, size_t index) const;
  void finish();

  const SiteMesh& sites_;
  const MeshWalk& walk_;
  const std::vector<uint32_t> tops_;
  const bool texture_;
  MirrorGuess mirror_;
  std::array<FeatureWeights, 4> weights_;
  std::vector<float> error_;       // mean of each site's
  std::vector<uint32_t> sibling_;  // of each vertex, the wedge coded last
  int turning_ = 0;                // above 0 where triangles turn left on the texture

  // Of the site at hand.
  std::span<const uint32_t> values_;
  uint32_t site_ = 0;
  uint32_t last_;  // coded before it
  FixedList<Unfolded, MeshWalk::kMaxKnown> triangles_;
  uint32_t tips_ = 0;
  std::vector<Channel> channels_;
  FixedList<Candidate, 6> candidates_;
  std::vector<uint32_t> coded_;  // channels so far
  double neighbour_error_ = 0, error_sum_ = 0, shift_ = 0;
};

}  // namespace reeb
