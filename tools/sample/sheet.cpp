#include <utility>
#include <vector>

#include "tools/io/attribute_values.h"
#include "tools/sample/sample.h"
#include "tools/vec3.h"

namespace reeb::tools {
namespace {

constexpr int kSide = 56;       ///< vertices along an edge
constexpr double kWidth = 2.0;  ///< metres
constexpr double kSpacing = kWidth / (kSide - 1);
constexpr int kStepsPerFrame = 4;
constexpr int kRounds = 12;        ///< constraint rounds per step
constexpr double kStep = 0.01;     ///< seconds; 25 frames per second
constexpr double kGravity = 9.81;  ///< metres per second squared
constexpr double kKept = 0.992;    ///< velocity left after a step
constexpr int kHookDistance = 11;  ///< every so many vertices of the upper edge hang on a hook

/// Two vertices that keep their distance.
struct Link {
  size_t a;
  size_t b;
  double rest;
  double stiffness;  ///< part of the deviation that a round corrects
};

/// Cloth by position-based dynamics (Mueller et al., "Position based dynamics", 2007).
class Cloth {
 public:
  Cloth() {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        // Hung a little narrower than it is, so that it falls into folds.
        const double z = 0.03 * turn_sine(0.045 * column);
        now_.push_back({0.93 * kSpacing * column, -kSpacing * row, z});
        add_links(row, column);
      }
    }
    before_ = now_;
  }

  void advance_frame() {
    for (int i = 0; i < kStepsPerFrame; ++i) step();
  }
  const std::vector<Vec3>& positions() const { return now_; }

 private:
  static size_t index(int row, int column) { return static_cast<size_t>(row) * kSide + column; }
  static bool hooked(size_t v) { return v < kSide && v % kHookDistance == 0; }

  void add_links(int row, int column) {
    const auto link = [&](int rows, int columns, double stiffness) {
      const int r = row + rows;
      const int c = column + columns;
      if (r >= kSide || c < 0 || c >= kSide) return;
      const double rest =
          kSpacing * std::sqrt(static_cast<double>(rows * rows + columns * columns));
      links_.push_back({index(row, column), index(r, c), rest, stiffness});
    };
    link(0, 1, 0.9);
    link(1, 0, 0.9);
    link(1, 1, 0.4);
    link(1, -1, 0.4);
    link(0, 2, 0.05);
    link(2, 0, 0.05);
  }

  void step() {
    time_ += kStep;
    const double gust = 3.2 * turn_sine(0.31 * time_) + 1.4 * turn_sine(0.83 * time_ + 0.2);
    for (size_t v = 0; v < now_.size(); ++v) {
      if (hooked(v)) continue;
      const Vec3 p = now_[v];
      const double local = turn_sine(0.6 * p.x + 0.4 * p.y - 0.9 * time_);
      const Vec3 force{0.8 * local, -kGravity, gust * (1 + 0.6 * local)};
      now_[v] = p + (p - before_[v]) * kKept + force * (kStep * kStep);
      before_[v] = p;
    }
    for (int round = 0; round < kRounds; ++round) {
      for (const Link& link : links_) relax(link);
    }
  }

  void relax(const Link& link) {
    const Vec3 d = now_[link.b] - now_[link.a];
    const double l = length(d);
    if (!(l > 0)) return;
    const Vec3 correction = d * (link.stiffness * (l - link.rest) / l);
    const bool fixed_a = hooked(link.a);
    const bool fixed_b = hooked(link.b);
    if (!fixed_a) now_[link.a] += correction * (fixed_b ? 1.0 : 0.5);
    if (!fixed_b) now_[link.b] -= correction * (fixed_a ? 1.0 : 0.5);
  }

  std::vector<Vec3> now_;
  std::vector<Vec3> before_;
  std::vector<Link> links_;
  double time_ = 0;
};

Connectivity grid_of_quads() {
  Connectivity out;
  out.vertex_count = kSide * kSide;
  for (uint32_t row = 0; row + 1 < kSide; ++row) {
    for (uint32_t column = 0; column + 1 < kSide; ++column) {
      const uint32_t v = row * kSide + column;
      out.face_sizes.push_back(4);
      for (const uint32_t corner : {v, v + kSide, v + kSide + 1, v + 1})
        out.corners.push_back(corner);
    }
  }
  return out;
}

/// How far the threads at each vertex are stretched, 0 where they have their length: the mean over
/// its neighbours in the grid. Appended.
void append_stretch(const std::vector<Vec3>& points, std::vector<float>& out) {
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      double sum = 0;
      int count = 0;
      for (const auto& [rows, columns] : {std::pair{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
        const int r = row + rows, c = column + columns;
        if (r < 0 || r >= kSide || c < 0 || c >= kSide) continue;
        const Vec3 thread = points[static_cast<size_t>(r * kSide + c)] -
                            points[static_cast<size_t>(row * kSide + column)];
        sum += length(thread) / kSpacing - 1;
        ++count;
      }
      out.push_back(static_cast<float>(sum / count));
    }
  }
}

}  // namespace

Sequence make_sheet(uint32_t frame_count) {
  Sequence sequence;
  Shot& shot = sequence.shots.emplace_back();
  shot.connectivity = grid_of_quads();
  shot.frame_count = frame_count;
  Cloth cloth;
  std::vector<float> stretch;
  for (uint32_t f = 0; f < frame_count; ++f) {
    if (f != 0) cloth.advance_frame();
    for (const Vec3& p : cloth.positions()) {
      for (const double x : {p.x, p.y, p.z}) shot.positions.push_back(static_cast<float>(x));
    }
    append_stretch(cloth.positions(), stretch);
  }
  shot.attributes.push_back(make_attribute("stretch", Semantic::kGeneric, Domain::kVertex,
                                           ValueType::kBinary32, 1, stretch));
  shot.attributes.back().animated = true;
  return sequence;
}

}  // namespace reeb::tools
