#include "tools/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "codec/common/mesh/faces.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

/// Sums of one frame, from which the figures follow.
struct Sums {
  double error = 0;   ///< sum of squared displacements
  double spread = 0;  ///< sum of squared distances from the mean
  double max_error = 0;
  uint64_t max_vertex = 0;
  uint64_t vertices = 0;
};

/// Coordinates of a frame as the files say them.
struct Coordinates {
  std::span<const float> positions;
  std::span<const float> remainders;  ///< empty where all are 0

  size_t size() const { return positions.size(); }
  double remainder(size_t i) const { return remainders.empty() ? 0.0 : remainders[i]; }
  double operator[](size_t i) const { return positions[i] + remainder(i); }
};

double squared_spread(const Coordinates& a) {
  const size_t vertices = a.size() / 3;
  const auto n = static_cast<double>(vertices);
  std::array<double, 3> mean{};
  for (size_t i = 0; i < a.size(); ++i) mean[i % 3] += a[i];
  for (double& m : mean) m /= n;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = a[i] - mean[i % 3];
    sum += d * d;
  }
  return sum;
}

Sums frame_sums(const Coordinates& a, const Coordinates& b) {
  Sums sums;
  sums.vertices = a.size() / 3;
  sums.spread = squared_spread(a);
  for (size_t v = 0; v < sums.vertices; ++v) {
    double squared = 0;
    for (size_t i = 3 * v; i < 3 * v + 3; ++i) {
      const double d = a[i] - b[i];
      squared += d * d;
      if (std::abs(d) > sums.max_error) {
        sums.max_error = std::abs(d);
        sums.max_vertex = v;
      }
    }
    sums.error += squared;
  }
  return sums;
}

bool same_bits(const Coordinates& a, const Coordinates& b) {
  if (std::memcmp(a.positions.data(), b.positions.data(), a.positions.size_bytes()) != 0) {
    return false;
  }
  for (size_t i = 0; i < a.size(); ++i) {
    if (a.remainder(i) != b.remainder(i)) return false;
  }
  return true;
}

ErrorFigures figures(const Sums& sums) {
  ErrorFigures out;
  if (sums.error > 0) out.kg = 100 * std::sqrt(sums.error / sums.spread);
  out.rmse = std::sqrt(sums.error / static_cast<double>(sums.vertices));
  out.max_error = sums.max_error;
  return out;
}

/// Steps through the frames of a sequence, shot after shot.
class FrameWalker {
 public:
  FrameWalker(const Sequence& sequence, const Remainders& remainders)
      : sequence_(sequence), remainders_(remainders) {
    skip_empty();
  }
  const Shot& shot() const { return sequence_.shots[shot_]; }
  Coordinates coordinates() const {
    const std::span<const float> positions = shot().frame(frame_);
    if (remainders_.empty() || remainders_[shot_].empty()) return {positions, {}};
    return {positions,
            std::span(remainders_[shot_]).subspan(frame_ * positions.size(), positions.size())};
  }
  void next() {
    ++frame_;
    skip_empty();
  }

 private:
  void skip_empty() {
    while (shot_ < sequence_.shots.size() && frame_ >= shot().frame_count) {
      ++shot_;
      frame_ = 0;
    }
  }

  const Sequence& sequence_;
  const Remainders& remainders_;
  size_t shot_ = 0;
  uint32_t frame_ = 0;
};

Status check_comparable(const Connectivity& a, const Connectivity& b, uint32_t frame) {
  const std::string where = "frame " + grouped(uint64_t{frame} + 1) + ": ";
  if (a.vertex_count != b.vertex_count) {
    return Status::invalid(where + grouped(a.vertex_count) + " against " +
                           counted(b.vertex_count, "vertex") +
                           "; only sequences with the same vertices can be compared");
  }
  if (a.face_sizes.size() != b.face_sizes.size()) {
    return Status::invalid(where + grouped(a.face_sizes.size()) + " against " +
                           counted(b.face_sizes.size(), "face") +
                           "; only sequences with the same faces can be compared");
  }
  if (!same_faces(a, b)) {
    return Status::invalid(where +
                           "the faces differ, so the vertices may be in another order; only "
                           "sequences with the same faces can be compared");
  }
  return {};
}

}  // namespace

double Comparison::relative_max_error() const {
  return overall.max_error > 0 ? overall.max_error / diagonal : 0;
}

uint64_t vertex_frames(const Sequence& sequence) {
  uint64_t n = 0;
  for (const Shot& s : sequence.shots) n += uint64_t{s.frame_count} * s.connectivity.vertex_count;
  return n;
}

double bounding_diagonal(const Sequence& sequence) {
  std::array<float, 3> low{};
  std::array<float, 3> high{};
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (const Shot& shot : sequence.shots) {
    for (size_t i = 0; i < shot.positions.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], shot.positions[i]);
      high[i % 3] = std::max(high[i % 3], shot.positions[i]);
    }
  }
  double squared = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (low[axis] > high[axis]) return 0;
    squared += std::pow(double{high[axis]} - double{low[axis]}, 2);
  }
  return std::sqrt(squared);
}

Status compare_sequences(const Sequence& original, const Sequence& other, Comparison& out,
                         const Remainders& original_remainders,
                         const Remainders& other_remainders) {
  out = Comparison();
  const uint32_t count = original.frame_count();
  if (count != other.frame_count()) {
    return Status::invalid(grouped(count) + " against " + counted(other.frame_count(), "frame") +
                           "; only sequences of equal length can be compared");
  }
  out.diagonal = bounding_diagonal(original);
  Sums total;
  FrameWalker a(original, original_remainders);
  FrameWalker b(other, other_remainders);
  const Shot* checked_a = nullptr;
  const Shot* checked_b = nullptr;
  for (uint32_t t = 0; t < count; ++t, a.next(), b.next()) {
    if (checked_a != &a.shot() || checked_b != &b.shot()) {
      Status status = check_comparable(a.shot().connectivity, b.shot().connectivity, t);
      if (!status.ok()) return status;
      checked_a = &a.shot();
      checked_b = &b.shot();
    }
    const Sums sums = frame_sums(a.coordinates(), b.coordinates());
    out.identical = out.identical && same_bits(a.coordinates(), b.coordinates());
    out.frames.push_back(figures(sums));
    total.error += sums.error;
    total.spread += sums.spread;
    total.vertices += sums.vertices;
    if (sums.max_error > total.max_error) {
      total.max_error = sums.max_error;
      out.max_frame = t;
      out.max_vertex = sums.max_vertex;
    }
  }
  out.overall = figures(total);
  return {};
}

}  // namespace reeb::tools
