// Guesses of grid positions from those of vertices coded before.
//
// Floating point is binary64 without contraction, in the order written, so that every machine makes
// the same guesses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/mesh/triangle_topology.h"
#include "codec/common/reference/guess_mixture.h"
#include "codec/common/reference/seam_finder.h"

namespace reeb {

using Vec3 = std::array<double, 3>;

/// Weights of features by ridge regression over all vertices seen.
class FeatureWeights {
 public:
  static constexpr size_t kCount = 3;
  using Row = std::array<double, kCount>;

  Row solve() const;
  void learn(const Row& features, double target, double confidence);

 private:
  double normal_[kCount][kCount] = {};  // lower triangle
  Row right_ = {};
};

/// Used for each vertex in the order of the topology: `start`, then for each axis `guess` and
/// `learn`.
class PointPredictor {
 public:
  /// `topology` must outlive the predictor.
  explicit PointPredictor(const TriangleTopology& topology);

  static constexpr uint32_t kMemory = 256;  ///< observations, see GuessMixture
  static constexpr uint32_t kKindCount = 6 * 5 + 2;

  /// `grid`: [point][xyz], of which those coded before are read.
  void start(uint32_t point, std::span<const int32_t> grid);
  void guess(size_t axis, GuessMixture& out) const;
  void learn(size_t axis, int32_t value);
  /// Where to look first, and how far around it (see GuessMixture::code).
  uint32_t likely(size_t axis) const;
  uint32_t reach(size_t axis) const;

 private:
  static constexpr size_t kMaxSingles = 2;

  double scale(size_t axis) const;
  void collect(uint32_t point, std::span<const int32_t> grid);
  void add_neighbour(uint32_t neighbour, std::span<const int32_t> grid);
  void add_parallelogram(uint32_t across, std::span<const int32_t> grid);
  void set_base(std::span<const int32_t> grid);
  void set_fitted();
  void set_spread();
  void set_normal_model();
  void drop_other_places(size_t axis, int32_t value);
  void finish();

  std::span<const uint32_t> triangles_;
  std::span<const uint32_t> twins_;
  const HalfEdgeFans& fans_;
  SeamFinder seams_;

  // Of every point: whether it is coded, its mean error, its neighbours in all and those coded.
  std::vector<uint8_t> coded_;
  std::vector<double> error_;
  std::vector<uint32_t> degree_, known_;
  std::vector<Vec3> known_sum_;  // positions of the coded neighbours
  std::array<FeatureWeights, 4> weights_;

  // Of the point at hand.
  uint32_t point_ = 0;
  uint32_t last_;  // coded before it
  std::vector<uint32_t> neighbours_;
  uint32_t parallelograms_ = 0, neighbour_count_ = 0, mirrors_ = 0, completions_ = 0;
  Vec3 sum_ = {}, square_sum_ = {}, neighbour_sum_ = {}, mirror_sum_ = {}, completion_sum_ = {};
  Vec3 normal_ = {};
  double error_sum_ = 0;
  std::vector<Vec3> singles_;
  std::vector<std::array<int32_t, 3>> twin_places_;  // where a seam may put it, as far as it agrees
  Vec3 base_ = {}, fitted_ = {};
  std::array<int32_t, 3> value_ = {};
  std::array<FeatureWeights::Row, 3> features_ = {};  // by axis
  double neighbour_error_ = 0, spread_ = 0, axis_error_ = 0;
  double lower_[3][3] = {};  // Cholesky factor of the residual's covariance
  Vec3 whitened_ = {};
};

}  // namespace reeb
