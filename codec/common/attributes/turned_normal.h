// Normals that are turned away from those that follow from positions.
#pragma once

#include <array>
#include <span>

namespace reeb {

using Direction = std::array<double, 3>;

/// Axes, each of length 1, that move with the surface: a site's computed normal, a direction along
/// the surface, and the one across both.
struct NormalFrame {
  Direction normal{}, along{}, across{};
  bool flat = false;  ///< the triangles of the site have no area; axes are those of space

  /// `sum`: the site's cross products; `edge`: of its first triangle, from the site to the next
  /// corner.
  NormalFrame(const Direction& sum, const Direction& edge);

  /// The unit vector that (u, v) stands for, on an octahedron whose tip is the normal; (0, 0): the
  /// normal as computed.
  std::array<float, 3> turned(double u, double v) const;
};

/// (u, v) of a direction with components along, across and normal, not all 0.
std::array<double, 2> to_octahedron(const Direction& local);

}  // namespace reeb
