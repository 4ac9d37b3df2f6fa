#include "retrieval/stretch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace reeb::retrieval {
namespace {

struct Piece {
  double radius, surface_area, plane_area, angle, value;
};

// Logarithm of the ratio of the singular values of the linear map between two triangles.
double angle_stretch(const Eigen::Matrix2d& from, const Eigen::Matrix2d& to) {
  if (std::abs(from.determinant()) <= 0) return kMaxAngleStretch;
  const Eigen::Matrix2d map = to * from.inverse();
  const double determinant = std::abs(map.determinant());
  const double squares = map.squaredNorm();
  // s + 1/s with s = sigma_1 / sigma_2.
  const double sum = squares / determinant;
  if (!(sum < 2 * std::cosh(kMaxAngleStretch))) return kMaxAngleStretch;
  return std::acosh(std::max(1.0, sum / 2));
}

Eigen::Matrix2d flattened(const Surface& surface, const Triple& t) {
  const Eigen::Vector3d p = surface.points[t[1]] - surface.points[t[0]];
  const Eigen::Vector3d q = surface.points[t[2]] - surface.points[t[0]];
  const double length = p.norm();
  Eigen::Matrix2d sides;
  sides << length, length > 0 ? p.dot(q) / length : 0, 0,
      length > 0 ? p.cross(q).norm() / length : 0;
  return sides;
}

std::vector<Piece> pieces_by_radius(const Patch& patch, const Unfolding& unfolding,
                                    std::span<const double> values) {
  std::vector<Piece> pieces;
  for (uint32_t t = 0; t < patch.original.size(); ++t) {
    if (patch.original[t] == kNone) continue;
    const auto& corners = unfolding.corners[t];
    const Eigen::Vector2d middle = corners.rowwise().mean();
    Eigen::Matrix2d sides;
    sides << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
    const Eigen::Matrix2d flat = flattened(patch.surface, patch.surface.triangles[t]);
    pieces.push_back({patch.is_disc() ? middle.norm() : middle.x(), flat.determinant() / 2,
                      std::abs(sides.determinant()) / 2, angle_stretch(flat, sides), values[t]});
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.radius < b.radius; });
  return pieces;
}

}  // namespace

Rings measure_rings(const Patch& patch, const Unfolding& unfolding,
                    std::span<const double> values) {
  double surface_area = 0, plane_area = 0;
  const std::vector<Piece> pieces = pieces_by_radius(patch, unfolding, values);
  for (const Piece& p : pieces) {
    surface_area += p.surface_area;
    plane_area += p.plane_area;
  }
  Rings rings;
  const double ring = surface_area / kRings;
  double before = 0;
  for (const Piece& p : pieces) {
    // A piece may lie in several rings.
    const double end = before + p.surface_area;
    for (int r = std::min(kRings - 1, static_cast<int>(before / ring));
         r < kRings && r * ring < end; ++r) {
      const double part =
          (std::min(end, (r + 1) * ring) - std::max(before, r * ring)) / p.surface_area;
      if (!(part > 0)) continue;
      rings.area[r] += part * p.plane_area / plane_area * kRings;
      rings.angle[r] += part * p.surface_area / ring * p.angle;
      rings.value[r] += part * p.surface_area / ring * p.value;
    }
    before = end;
  }
  for (double& a : rings.area) a = a > 0 ? std::max(std::log(a), kMinAreaStretch) : kMinAreaStretch;
  return rings;
}

}  // namespace reeb::retrieval
