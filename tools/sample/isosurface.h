// A triangle mesh of the zero set of a function in space.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tools/vec3.h"

namespace reeb::tools {

struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

using Field = std::function<double(const Vec3&)>;

/// Surface nets (S. Gibson, "Constrained elastic surface nets", MICCAI 1998) on a grid of cubes of
/// width `cell` over the box, then `relaxations` rounds of smoothing along the surface that keep
/// the vertices on it. `field` is negative inside, positive on the border of the box, and close to
/// a distance near its zero set; the surface should be smooth at the scale of a cell.
TriangleMesh isosurface(const Field& field, const Vec3& low, const Vec3& high, double cell,
                        int relaxations);

/// Vertices that share an edge with each vertex, ascending.
std::vector<std::vector<uint32_t>> vertex_rings(const TriangleMesh& mesh);

}  // namespace reeb::tools
