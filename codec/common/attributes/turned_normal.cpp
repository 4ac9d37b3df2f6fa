#include "codec/common/attributes/turned_normal.h"

#include <cmath>
#include <cstddef>

namespace reeb {

namespace {

double dot(const Direction& a, const Direction& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// `a` + factor * `b`.
Direction sum(const Direction& a, double factor, const Direction& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// True, and of length 1, where that can be.
bool normalise(Direction& a) {
  const double length = std::sqrt(dot(a, a));
  if (!(length > 0) || !std::isfinite(length)) return false;
  const double scale = 1 / length;
  for (double& x : a) x = x * scale;
  return true;
}

size_t least_axis(const Direction& n) {
  size_t least = 0;
  for (size_t a = 1; a < 3; ++a) {
    if (std::abs(n[a]) < std::abs(n[least])) least = a;
  }
  return least;
}

double side(double x) { return x < 0 ? -1 : 1; }

}  // namespace

NormalFrame::NormalFrame(const Direction& area, const Direction& edge) : normal(area) {
  flat = !normalise(normal);
  if (flat) normal = {0, 0, 1};
  along = sum(edge, -dot(edge, normal), normal);
  if (flat || !normalise(along)) {
    Direction axis{};
    const size_t least = least_axis(normal);
    axis[least] = 1;
    along = sum(axis, -normal[least], normal);
    normalise(along);
  }
  across = {normal[1] * along[2] - normal[2] * along[1],
            normal[2] * along[0] - normal[0] * along[2],
            normal[0] * along[1] - normal[1] * along[0]};
}

std::array<float, 3> NormalFrame::turned(double u, double v) const {
  Direction out = normal;
  if (u == 0 && v == 0) {
    if (flat) out = {};
  } else {
    double x = u, y = v;
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z < 0) {
      x = (1 - std::abs(v)) * side(u);
      y = (1 - std::abs(u)) * side(v);
    }
    for (size_t a = 0; a < 3; ++a) out[a] = x * along[a] + y * across[a] + z * normal[a];
    normalise(out);
  }
  return {static_cast<float>(out[0]), static_cast<float>(out[1]), static_cast<float>(out[2])};
}

std::array<double, 2> to_octahedron(const Direction& local) {
  const double length = std::abs(local[0]) + std::abs(local[1]) + std::abs(local[2]);
  const double u = local[0] / length, v = local[1] / length;
  if (local[2] >= 0) return {u, v};
  return {(1 - std::abs(v)) * side(u), (1 - std::abs(u)) * side(v)};
}

}  // namespace reeb
