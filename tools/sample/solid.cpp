#include "tools/sample/solid.h"

#include <algorithm>

namespace reeb::tools {
namespace {

constexpr double kFirstCells = 40;  // along the diagonal, to learn how large the surface is
constexpr int kRelaxations = 6;

// A minimum whose crease is rounded off over `blend`.
double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend * 0.25;
}

Pose inverse(const Pose& pose) {
  const auto& r = pose.rows;
  Pose out;
  out.rows = {Vec3{r[0].x, r[1].x, r[2].x}, Vec3{r[0].y, r[1].y, r[2].y},
              Vec3{r[0].z, r[1].z, r[2].z}};
  out.shift = Vec3{} - Pose{out.rows, {}}(pose.shift);
  return out;
}

}  // namespace

double Solid::Cone::distance(const Vec3& p) const {
  const double square = dot(axis, axis);
  const double t = square > 0 ? std::clamp(dot(p - from, axis) / square, 0.0, 1.0) : 0;
  return length(p - (from + axis * t)) - (from_radius + t * (to_radius - from_radius));
}

double Solid::Box::distance(const Vec3& p) const {
  const Vec3 q = into(p);
  const Vec3 beyond{std::abs(q.x) - half.x + rounding, std::abs(q.y) - half.y + rounding,
                    std::abs(q.z) - half.z + rounding};
  const Vec3 outside{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
  return length(outside) + std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0) - rounding;
}

void Solid::include(const Vec3& p, double radius) {
  low_ = {std::min(low_.x, p.x - radius), std::min(low_.y, p.y - radius),
          std::min(low_.z, p.z - radius)};
  high_ = {std::max(high_.x, p.x + radius), std::max(high_.y, p.y + radius),
           std::max(high_.z, p.z + radius)};
}

void Solid::add_cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius) {
  cones_.push_back({from, to - from, from_radius, to_radius});
  include(from, from_radius);
  include(to, to_radius);
}

void Solid::add_box(const Pose& place, const Vec3& half, double rounding) {
  boxes_.push_back({inverse(place), half, rounding});
  for (int corner = 0; corner < 8; ++corner) {
    include(place({corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                   corner & 4 ? half.z : -half.z}),
            0);
  }
}

void Solid::carve_cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius) {
  carved_.push_back({from, to - from, from_radius, to_radius});
}

double Solid::value(const Vec3& p) const {
  double d = 1e9;
  for (const Cone& cone : cones_) d = smooth_min(d, cone.distance(p), blend_);
  for (const Box& box : boxes_) d = smooth_min(d, box.distance(p), blend_);
  for (const Cone& cone : carved_) d = -smooth_min(-d, cone.distance(p), blend_ * 0.5);
  return d;
}

TriangleMesh Solid::surface(uint32_t vertices) const {
  const Field field = [this](const Vec3& p) { return value(p); };
  double cell = length(high_ - low_) / kFirstCells;
  const auto mesh_of = [&](int relaxations) {
    const Vec3 margin = Vec3{1, 1, 1} * (2 * cell + blend_);
    return isosurface(field, low_ - margin, high_ + margin, cell, relaxations);
  };
  const double first = static_cast<double>(mesh_of(0).vertices.size());
  cell *= std::sqrt(std::max(first, 1.0) / vertices);
  return mesh_of(kRelaxations);
}

}  // namespace reeb::tools
