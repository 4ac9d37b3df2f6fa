// Small vectors for the samples and pictures, in IEEE-754 operations that every machine rounds
// alike.
#pragma once

#include <array>
#include <cmath>

namespace reeb::tools {

struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;

  Vec3 operator+(const Vec3& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Vec3 operator-(const Vec3& b) const { return {x - b.x, y - b.y, z - b.z}; }
  Vec3 operator*(double s) const { return {x * s, y * s, z * s}; }
  Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
};

inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// Zero stays zero.
inline Vec3 normalized(const Vec3& a) {
  const double l = length(a);
  return l > 0 ? a * (1 / l) : a;
}

/// sin(2 pi turns), |turns| < 1e9, to 1e-12. Unlike std::sin the same on every machine.
inline double turn_sine(double turns) {
  double t = turns - std::floor(turns);  // [0, 1)
  if (t > 0.75) {
    t -= 1;
  } else if (t > 0.25) {
    t = 0.5 - t;
  }
  const double x = t * 6.283185307179586476925;  // [-pi/2, pi/2]
  const double x2 = x * x;
  // Taylor's series, Horner's scheme; the first term left out is below 1e-14 at pi/2.
  double sum = 1;
  for (int k = 10; k >= 1; --k) sum = 1 - sum * x2 / ((2 * k) * (2 * k + 1));
  return x * sum;
}
inline double turn_cosine(double turns) { return turn_sine(turns + 0.25); }

/// Rotation and translation, x -> rows * x + shift.
struct Pose {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 shift;

  Vec3 operator()(const Vec3& p) const {
    return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + shift;
  }
  /// First `inner`, then this.
  Pose operator*(const Pose& inner) const {
    Pose out;
    const Vec3 cx{inner.rows[0].x, inner.rows[1].x, inner.rows[2].x};
    const Vec3 cy{inner.rows[0].y, inner.rows[1].y, inner.rows[2].y};
    const Vec3 cz{inner.rows[0].z, inner.rows[1].z, inner.rows[2].z};
    for (size_t i = 0; i < 3; ++i) {
      out.rows[i] = {dot(rows[i], cx), dot(rows[i], cy), dot(rows[i], cz)};
    }
    out.shift = (*this)(inner.shift);
    return out;
  }
};

/// Rotation about axis 0, 1 or 2 (x, y, z) through `pivot`.
inline Pose rotation(int axis, double turns, const Vec3& pivot) {
  const double c = turn_cosine(turns);
  const double s = turn_sine(turns);
  Pose pose;
  if (axis == 0) pose.rows = {Vec3{1, 0, 0}, Vec3{0, c, -s}, Vec3{0, s, c}};
  if (axis == 1) pose.rows = {Vec3{c, 0, s}, Vec3{0, 1, 0}, Vec3{-s, 0, c}};
  if (axis == 2) pose.rows = {Vec3{c, -s, 0}, Vec3{s, c, 0}, Vec3{0, 0, 1}};
  const Vec3 turned = pose(pivot);
  pose.shift = pivot - turned;
  return pose;
}

}  // namespace reeb::tools
