// Procedural meshes and motions for the codec tests, odd topologies among them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::test {

struct Shape {
  std::string name;
  Connectivity connectivity;
  std::vector<float> positions;  ///< [vertex][xyz]

  void add_face(const std::vector<uint32_t>& corners);
  uint32_t add_vertex(float x, float y, float z);
};

Shape tetrahedron();
Shape strip(uint32_t triangles);              ///< open, in the plane
Shape doubled_strip(uint32_t vertices);       ///< every triangle twice
Shape grid(uint32_t columns, uint32_t rows);  ///< open square of quadrilaterals, wavy
/// Triangles, mirrored at x = 0: 2 half + 1 columns, vertex v of a row is mirrored by 2 half - v.
Shape butterfly(uint32_t half, uint32_t rows);
Shape torus(uint32_t around, uint32_t across);     ///< triangles, radii 3 and 1
Shape hub(uint32_t spokes);                        ///< a closed fan around one vertex
Shape fins(uint32_t count);                        ///< non-manifold: triangles at a common edge
Shape two_components();                            ///< a torus and a tetrahedron
Shape with_isolated(Shape shape, uint32_t count);  ///< vertices without a face, in between
Shape with_duplicates();                           ///< two grids along a seam of equal places
Shape mixed_polygons();                            ///< 3 to 6 corners, a degenerate and a 2-gon
Shape single_vertex();
Shape points_only(uint32_t count);  ///< no faces

/// All of the above at a small size.
std::vector<Shape> small_shapes();

/// Triangles of an n by n grid of points, by rows.
std::vector<uint32_t> grid_triangles(uint32_t n);

/// Every face as a fan, degenerate triangles left out.
std::vector<uint32_t> triangles_of(const Connectivity& connectivity);

/// Positions on a grid of `bits` bits over the longest side.
std::vector<int32_t> on_grid(const Shape& shape, uint32_t bits);

/// Position of a vertex at rest and a time in 0 .. 1 -> position then.
using Motion = std::function<void(const float* rest, double time, double* xyz)>;
void bend(const float* rest, double time, double* xyz);  ///< smooth, all over
void rest(const float* rest, double time, double* xyz);  ///< none at all

Shot animate(const Shape& shape, uint32_t frames, const Motion& motion = bend);
Sequence sequence_of(std::vector<Shot> shots);

}  // namespace reeb::test
