// Solids put together of rounded cones and boxes, and their surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sample/isosurface.h"

namespace reeb::tools {

class Solid {
 public:
  /// Parts flow into each other over `blend`, a length.
  explicit Solid(double blend) : blend_(blend) {}

  /// A ball that moves along a segment while its radius changes.
  void add_cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius);
  /// A box whose corners are rounded: half its extents along the axes of `place`.
  void add_box(const Pose& place, const Vec3& half, double rounding);
  /// Takes such a cone away again.
  void carve_cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius);

  /// Negative inside.
  double value(const Vec3& p) const;

  /// Surface of about `vertices` vertices; closed, of any genus and of any number of components,
  /// not manifold where two sheets of it pass one cell of its grid.
  TriangleMesh surface(uint32_t vertices) const;

 private:
  struct Cone {
    Vec3 from, axis;
    double from_radius, to_radius;
    double distance(const Vec3& p) const;
  };
  struct Box {
    Pose into;  // from space to the axes of the box
    Vec3 half;
    double rounding;
    double distance(const Vec3& p) const;
  };
  void include(const Vec3& p, double radius);

  double blend_;
  std::vector<Cone> cones_, carved_;
  std::vector<Box> boxes_;
  Vec3 low_{1e9, 1e9, 1e9}, high_{-1e9, -1e9, -1e9};
};

}  // namespace reeb::tools
