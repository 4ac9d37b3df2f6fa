#include "codec/common/reference/point_predictor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/common/mesh/connectivity.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr double kMinScale = 0.3;     // grid steps; rounding alone makes about that
constexpr double kOffSurface = 0.05;  // variance along the normal, that in the plane being 1

// Kinds of guesses; each is kept apart by what is known around the vertex (see situation).
enum Kind : uint32_t { kMean, kFitted, kFittedBySpread, kSingle, kInPlane, kLast, kSeam };

uint32_t third_corner(uint32_t h) { return next_half_edge(next_half_edge(h)); }

int64_t to_fixed(double x) {
  const double rounded = std::clamp(x, -1e6, 1e6) * 256 + 0.5;
  const auto toward_zero = static_cast<int64_t>(rounded);
  return toward_zero - (static_cast<double>(toward_zero) > rounded ? 1 : 0);
}

void add_guess(uint32_t kind, double place, double scale, GuessMixture& out) {
  // Value v stands for the interval around it, so the interval that starts at v is moved by a half.
  const auto fixed_scale = static_cast<uint32_t>(std::clamp(scale * 256, 64.0, 16777216.0));
  out.add(kind, to_fixed(place) + 128, fixed_scale);
}

}  // namespace

// Cholesky decomposition of the normal matrix, whose diagonal the ridge keeps away from 0.
FeatureWeights::Row FeatureWeights::solve() const {
  constexpr double kRidge = 30;
  constexpr double kRelativeRidge = 1.001;
  double lower[kCount][kCount];
  Row y;
  for (size_t i = 0; i < kCount; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      double s = i == j ? normal_[i][i] * kRelativeRidge + kRidge : normal_[i][j];
      for (size_t k = 0; k < j; ++k) s -= lower[i][k] * lower[j][k];
      lower[i][j] = i == j ? std::sqrt(std::max(s, 1e-9)) : s / lower[j][j];
    }
    double s = right_[i];
    for (size_t k = 0; k < i; ++k) s -= lower[i][k] * y[k];
    y[i] = s / lower[i][i];
  }
  for (size_t i = kCount; i-- > 0;) {
    for (size_t k = i + 1; k < kCount; ++k) y[i] -= lower[k][i] * y[k];
    y[i] /= lower[i][i];
  }
  return y;
}

void FeatureWeights::learn(const Row& features, double target, double confidence) {
  for (size_t i = 0; i < kCount; ++i) {
    const double weighted = confidence * features[i];
    for (size_t j = 0; j <= i; ++j) normal_[i][j] += weighted * features[j];
    right_[i] += weighted * target;
  }
}

PointPredictor::PointPredictor(const TriangleTopology& topology)
    : triangles_(topology.triangles),
      twins_(topology.twins),
      fans_(topology.fans),
      seams_(topology.triangles, topology.twins, topology.fans, topology.point_count()),
      coded_(topology.point_count()),
      error_(topology.point_count()),
      degree_(topology.point_count()),
      known_(topology.point_count()),
      known_sum_(topology.point_count()),
      last_(kNone) {
  for (uint32_t h = 0; h < triangles_.size(); ++h) {
    ++degree_[triangles_[h]];
    if (twins_[h] == kNoTwin) ++degree_[triangles_[next_half_edge(h)]];
  }
}

// A neighbour is the end of a half-edge that starts here, or the start of one without twin that
// ends here; both are the same seen from the other side.
void PointPredictor::collect(uint32_t point, std::span<const int32_t> grid) {
  neighbours_.clear();
  for (const uint32_t h : fans_[point]) {
    neighbours_.push_back(triangles_[next_half_edge(h)]);
    const uint32_t before = third_corner(h);
    if (twins_[before] == kNoTwin) neighbours_.push_back(triangles_[before]);
  }
  for (const uint32_t n : neighbours_) {
    if (coded_[n] != 0) add_neighbour(n, grid);
  }
  for (const uint32_t h : fans_[point]) add_parallelogram(next_half_edge(h), grid);
}

void PointPredictor::add_neighbour(uint32_t n, std::span<const int32_t> grid) {
  ++neighbour_count_;
  error_sum_ += error_[n];
  const double known = known_[n];
  const bool all_but_one = degree_[n] == known_[n] + 1;
  if (known_[n] > 0) ++mirrors_;
  if (known_[n] > 0 && all_but_one) ++completions_;
  for (size_t i = 0; i < 3; ++i) {
    const double x = grid[size_t{n} * 3 + i];
    neighbour_sum_[i] += x;
    if (known_[n] == 0) continue;
    mirror_sum_[i] += 2 * x - known_sum_[n][i] / known;
    if (all_but_one) completion_sum_[i] += (known + 1) * x - known_sum_[n][i];
  }
}

// The triangle beyond half-edge `across`, mirrored at the middle of that edge.
void PointPredictor::add_parallelogram(uint32_t across, std::span<const int32_t> grid) {
  if (twins_[across] == kNoTwin) return;
  const uint32_t corners[3] = {triangles_[across], triangles_[next_half_edge(across)],
                               triangles_[third_corner(twins_[across])]};
  for (const uint32_t c : corners) {
    if (coded_[c] == 0) return;
  }
  Vec3 u, v, tip;
  for (size_t i = 0; i < 3; ++i) {
    const double far = grid[size_t{corners[2]} * 3 + i];
    u[i] = grid[size_t{corners[0]} * 3 + i] - far;
    v[i] = grid[size_t{corners[1]} * 3 + i] - far;
    tip[i] = far + u[i] + v[i];
    sum_[i] += tip[i];
    square_sum_[i] += tip[i] * tip[i];
  }
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    normal_[i] += u[j] * v[k] - u[k] * v[j];
  }
  ++parallelograms_;
  if (singles_.size() < kMaxSingles) singles_.push_back(tip);
}

// The best guess that needs no learning: parallelograms, else neighbours, else the vertex before.
void PointPredictor::set_base(std::span<const int32_t> grid) {
  for (size_t i = 0; i < 3; ++i) {
    if (parallelograms_ > 0) {
      base_[i] = sum_[i] / parallelograms_;
    } else if (neighbour_count_ > 0) {
      base_[i] = neighbour_sum_[i] / neighbour_count_;
    } else {
      base_[i] = last_ == kNone ? 0.0 : double(grid[size_t{last_} * 3 + i]);
    }
    FeatureWeights::Row& f = features_[i];
    f[0] = neighbour_count_ > 0 ? neighbour_sum_[i] / neighbour_count_ - base_[i] : 0;
    f[1] = mirrors_ > 0 ? mirror_sum_[i] / mirrors_ - base_[i] : 0;
    f[2] = completions_ > 0 ? completion_sum_[i] / completions_ - base_[i] : 0;
  }
}

void PointPredictor::set_fitted() {
  const FeatureWeights::Row w = weights_[std::min(parallelograms_, 3u)].solve();
  for (size_t i = 0; i < 3; ++i) {
    fitted_[i] = base_[i];
    for (size_t k = 0; k < FeatureWeights::kCount; ++k) fitted_[i] += w[k] * features_[i][k];
  }
}

// How far the parallelograms are apart, as a scale of the error to expect.
void PointPredictor::set_spread() {
  double sum = 0;
  for (size_t i = 0; i < 3 && parallelograms_ > 0; ++i) {
    const double mean = sum_[i] / parallelograms_;
    sum += std::sqrt(std::max(square_sum_[i] / parallelograms_ - mean * mean, 0.0));
  }
  spread_ = kMinScale + 0.7 * sum / 3;
}

// Neighbours tell the plane better than the place in it: covariance I - (1 - kOffSurface) n n^T.
void PointPredictor::set_normal_model() {
  double length2 = 0;
  for (const double x : normal_) length2 += x * x;
  const double factor = length2 > 0 ? (kOffSurface - 1) / length2 : 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      double s = (i == j ? 1.0 : 0.0) + factor * normal_[i] * normal_[j];
      for (size_t k = 0; k < j; ++k) s -= lower_[i][k] * lower_[j][k];
      lower_[i][j] = i == j ? std::sqrt(std::max(s, 1e-6)) : s / lower_[j][j];
    }
  }
}

void PointPredictor::start(uint32_t point, std::span<const int32_t> grid) {
  point_ = point;
  parallelograms_ = neighbour_count_ = mirrors_ = completions_ = 0;
  sum_ = square_sum_ = neighbour_sum_ = mirror_sum_ = completion_sum_ = normal_ = {};
  error_sum_ = axis_error_ = 0;
  singles_.clear();
  twin_places_.clear();
  for (const uint32_t p : seams_.find(point)) {
    const int32_t* xyz = &grid[size_t{p} * 3];
    twin_places_.push_back({xyz[0], xyz[1], xyz[2]});
  }
  collect(point, grid);
  set_base(grid);
  set_fitted();
  set_spread();
  set_normal_model();
  neighbour_error_ = neighbour_count_ > 0 ? error_sum_ / neighbour_count_ : 0;
}

// Errors of the neighbours, then also those of the axes before.
double PointPredictor::scale(size_t axis) const {
  const double of_neighbours = neighbour_error_ + kMinScale;
  if (axis == 0) return of_neighbours;
  return std::max((2 * of_neighbours + axis_error_ / static_cast<double>(axis)) / 3, kMinScale);
}

uint32_t PointPredictor::likely(size_t axis) const {
  if (axis > 0 && !twin_places_.empty()) return static_cast<uint32_t>(twin_places_[0][axis]);
  return static_cast<uint32_t>(std::clamp(std::floor(fitted_[axis] + 0.5), 0.0, double{kGridMax}));
}

uint32_t PointPredictor::reach(size_t axis) const {
  return 1 + static_cast<uint32_t>(std::min(scale(axis), 1000.0));
}

void PointPredictor::guess(size_t axis, GuessMixture& out) const {
  out.clear();
  // What is known: nothing, an edge, or one, two, more parallelograms.
  const uint32_t situation =
      parallelograms_ > 0 ? 1 + std::min(parallelograms_, 3u) : (neighbour_count_ > 1 ? 1 : 0);
  const auto kind = [&](Kind k) { return k * 5 + situation; };
  const double scale = this->scale(axis);
  if (parallelograms_ < 2) add_guess(kind(kMean), base_[axis], scale, out);
  add_guess(kind(kFittedBySpread), fitted_[axis], spread_, out);
  if (neighbour_count_ == 0) add_guess(kind(kLast), base_[axis], scale, out);
  for (const auto& place : twin_places_) {
    add_guess(kSeam * 5 + (axis > 0 ? 1 : 0), place[axis], kMinScale, out);
  }
  if (parallelograms_ == 0) return;
  double shift = 0;
  for (size_t k = 0; k < axis; ++k) shift += lower_[axis][k] * whitened_[k];
  add_guess(kind(kInPlane), fitted_[axis] + shift, scale * lower_[axis][axis], out);
  if (parallelograms_ == 1) return;
  add_guess(kind(kFitted), fitted_[axis], scale, out);
  for (const Vec3& tip : singles_) add_guess(kind(kSingle), tip[axis], scale, out);
}

void PointPredictor::learn(size_t axis, int32_t value) {
  value_[axis] = value;
  const double error = value - fitted_[axis];
  axis_error_ += std::abs(error);
  double rest = error;
  for (size_t k = 0; k < axis; ++k) rest -= lower_[axis][k] * whitened_[k];
  whitened_[axis] = rest / lower_[axis][axis];
  // Outliers count little.
  const double confidence = 1 / (kMinScale + neighbour_error_ * neighbour_error_ + error * error);
  weights_[std::min(parallelograms_, 3u)].learn(features_[axis], value - base_[axis], confidence);
  drop_other_places(axis, value);
  if (axis == 2) finish();
}

void PointPredictor::drop_other_places(size_t axis, int32_t value) {
  std::erase_if(twin_places_, [&](const auto& place) { return place[axis] != value; });
}

void PointPredictor::finish() {
  coded_[point_] = 1;
  error_[point_] = axis_error_ / 3;
  last_ = point_;
  seams_.add(point_, value_);
  for (const uint32_t n : neighbours_) {
    ++known_[n];
    for (size_t i = 0; i < 3; ++i) known_sum_[n][i] += value_[i];
  }
}

}  // namespace reeb
