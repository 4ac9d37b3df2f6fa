#include "conformance/retrieval/baselines.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "segmentation/eigenpairs.h"
#include "segmentation/surface.h"

namespace reeb::conformance {
namespace {

using segmentation::Eigenpairs;
using segmentation::Point;
using segmentation::Surface;

constexpr uint32_t kEigenpairs = 60;
constexpr size_t kShapeDna = 20;
constexpr int kTimes = 10, kBins = 64;
constexpr double kFirstTime = 0.1, kLastTime = 5;  // over the first eigenvalue
constexpr double kMinHeat = -2, kMaxHeat = 5;      // logarithm of the signature times the area
constexpr int kPairs = 40000;
constexpr double kMaxDistance = 2;  // of distances over the root of the area
constexpr double kMinPiece = 0.02;

struct Piece {
  const Surface* surface;
  Eigenpairs pairs;
  Eigen::VectorXd mass;
};

std::vector<Piece> large_pieces(const segmentation::Pieces& pieces, double area) {
  std::vector<Piece> out;
  for (const Surface& surface : pieces.surfaces) {
    if (total_area(surface) < kMinPiece * area || surface.vertex_count() < 8) continue;
    const auto laplacian = build_laplacian(surface);
    out.push_back({&surface, smallest_eigenpairs(laplacian, kEigenpairs), laplacian.mass});
  }
  return out;
}

void add_to_bin(std::vector<double>& histogram, size_t first, double part, double weight) {
  const int bin = std::clamp(static_cast<int>(std::floor(part * kBins)), 0, kBins - 1);
  histogram[first + static_cast<size_t>(bin)] += weight;
}

std::vector<double> shape_dna(const std::vector<Piece>& pieces, double area) {
  std::vector<double> values;
  for (const Piece& piece : pieces) {
    for (const double lambda : piece.pairs.values) values.push_back(std::max(lambda, 0.0) * area);
  }
  std::sort(values.begin(), values.end());
  values.resize(std::max(values.size(), kShapeDna + 1), 0.0);
  std::vector<double> dna;
  for (size_t i = 1; i <= kShapeDna; ++i) dna.push_back(values[i] / static_cast<double>(i));
  return dna;
}

std::vector<double> heat_histogram(const std::vector<Piece>& pieces, double area) {
  std::vector<double> histogram(size_t{kTimes} * kBins, 0.0);
  if (pieces.empty() || pieces[0].pairs.values.size() < 2) return histogram;
  const double first = pieces[0].pairs.values[1];
  double mass = 0;
  for (const Piece& piece : pieces) mass += piece.mass.sum();
  for (int k = 0; k < kTimes; ++k) {
    const double t = kFirstTime * std::pow(kLastTime / kFirstTime, k / double{kTimes - 1}) / first;
    for (const Piece& piece : pieces) {
      const Eigen::VectorXd heat = piece.pairs.vectors.array().square().matrix() *
                                   (-t * piece.pairs.values).array().exp().matrix();
      for (Eigen::Index v = 0; v < heat.size(); ++v) {
        const double part =
            (std::log(std::max(heat[v] * area, 1e-30)) - kMinHeat) / (kMaxHeat - kMinHeat);
        add_to_bin(histogram, size_t{kBins} * k, part, piece.mass[v] / mass);
      }
    }
  }
  return histogram;
}

// Pairs of points chosen by area.
class PointPicker {
 public:
  explicit PointPicker(const segmentation::Pieces& pieces) {
    for (const Surface& surface : pieces.surfaces) {
      for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
        total_ += triangle_area(surface, t);
        until_.push_back(total_);
        triangles_.emplace_back(&surface, t);
      }
    }
  }

  Point pick() {
    const auto at = std::lower_bound(until_.begin(), until_.end(), uniform() * total_);
    const auto& [surface, t] = triangles_[std::min<size_t>(at - until_.begin(), until_.size() - 1)];
    const auto [a, b, c] = surface->triangles[t];
    const double r = std::sqrt(uniform()), s = uniform();
    return (1 - r) * surface->points[a] + r * (1 - s) * surface->points[b] +
           r * s * surface->points[c];
  }

 private:
  double uniform() { return static_cast<double>(random_()) / 4294967296.0; }

  std::mt19937 random_{1};
  double total_ = 0;
  std::vector<double> until_;
  std::vector<std::pair<const Surface*, uint32_t>> triangles_;
};

std::vector<double> d2_histogram(const segmentation::Pieces& pieces, double area) {
  std::vector<double> histogram(kBins, 0.0);
  PointPicker picker(pieces);
  for (int i = 0; i < kPairs; ++i)
    add_to_bin(histogram, 0,
               (picker.pick() - picker.pick()).norm() / std::sqrt(area) / kMaxDistance,
               1.0 / kPairs);
  return histogram;
}

}  // namespace

Baselines describe(std::span<const float> positions, std::span<const uint32_t> triangles) {
  const segmentation::Pieces pieces = segmentation::split_pieces(positions, triangles, true);
  double area = 0;
  for (const Surface& surface : pieces.surfaces) area += total_area(surface);
  if (!(area > 0))
    return {shape_dna({}, 0), heat_histogram({}, 0), std::vector<double>(kBins, 0.0)};
  const std::vector<Piece> large = large_pieces(pieces, area);
  return {shape_dna(large, area), heat_histogram(large, area), d2_histogram(pieces, area)};
}

}  // namespace reeb::conformance
