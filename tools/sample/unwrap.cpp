#include "tools/sample/unwrap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace reeb::tools {
namespace {

constexpr double kMargin = 0.04;  ///< of a tile, on each side
constexpr double kAround = 0.75;  ///< of a tile, that a turn takes; triangles at the cut go beyond

/// 0 .. 1 around the circle, rising with the angle, of quotients alone.
double turn_of(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  if (!(sum > 0)) return 0;
  const double part = y / sum / 4;
  return x < 0 ? 0.5 - part : y < 0 ? 1 + part : part;
}

/// A tile and the directions in it.
class Roll {
 public:
  Roll(const UnwrapAxis& axis, size_t tile, size_t tiles_in_row)
      : axis_(axis),
        along_(normalized(axis.to - axis.from)),
        side_(normalized(cross(along_, std::abs(along_.y) < 0.8 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}))),
        front_(cross(along_, side_)),
        size_(1.0 / static_cast<double>(tiles_in_row)),
        left_(size_ * static_cast<double>(tile % tiles_in_row)),
        low_(size_ * static_cast<double>(tile / tiles_in_row)) {}

  double turn(const Vec3& p) const {
    const Vec3 d = p - axis_.from;
    return turn_of(dot(d, side_), dot(d, front_));
  }
  double u(double turn) const { return left_ + size_ * (kMargin + kAround * turn); }
  double v(const Vec3& p) const {
    const double reach = length(axis_.to - axis_.from);
    const double part = (dot(p - axis_.from, along_) / reach + 1) / 3;
    return low_ + size_ * (kMargin + (1 - 2 * kMargin) * std::clamp(part, 0.0, 1.0));
  }

 private:
  UnwrapAxis axis_;
  Vec3 along_, side_, front_;
  double size_, left_, low_;
};

Vec3 at(std::span<const float> positions, uint32_t v) {
  return {positions[size_t{3} * v], positions[size_t{3} * v + 1], positions[size_t{3} * v + 2]};
}

}  // namespace

std::vector<float> unwrap(const TriangleMesh& mesh, std::span<const UnwrapAxis> axes,
                          std::span<const size_t> axis_of) {
  size_t row = 1;
  while (row * row < axes.size()) ++row;
  std::vector<Roll> rolls;
  for (size_t i = 0; i < axes.size(); ++i) rolls.emplace_back(axes[i], i, row);
  std::vector<float> out;
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Roll& roll = rolls[axis_of[f]];
    std::array<double, 3> turns{};
    for (size_t i = 0; i < 3; ++i) turns[i] = roll.turn(mesh.vertices[mesh.triangles[f][i]]);
    const double last = std::max({turns[0], turns[1], turns[2]});
    for (size_t i = 0; i < 3; ++i) {
      // Across the cut the turn goes on; an end of the axis may lie in between.
      const double turn = last - turns[i] > 0.5 ? std::min(turns[i] + 1, 1.2) : turns[i];
      out.push_back(static_cast<float>(roll.u(turn)));
      out.push_back(static_cast<float>(roll.v(mesh.vertices[mesh.triangles[f][i]])));
    }
  }
  return out;
}

void append_normals(const TriangleMesh& mesh, std::span<const uint8_t> faceted,
                    std::span<const float> positions, std::vector<float>& out) {
  std::vector<Vec3> own, sums(mesh.vertices.size());
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    const Vec3 a = at(positions, t[0]);
    own.push_back(cross(at(positions, t[1]) - a, at(positions, t[2]) - a));
    for (const uint32_t v : t) {
      if (faceted[f] == 0) sums[v] += own[f];
    }
  }
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const uint32_t v : mesh.triangles[f]) {
      const Vec3 n = normalized(faceted[f] != 0 ? own[f] : sums[v]);
      for (const double x : {n.x, n.y, n.z}) out.push_back(static_cast<float>(x));
    }
  }
}

}  // namespace reeb::tools
