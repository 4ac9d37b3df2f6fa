// Procedural meshes whose topology and extremities are known.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "segmentation/surface.h"

namespace reeb::segmentation::shapes {

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> triangles;

  uint32_t vertex_count() const { return static_cast<uint32_t>(positions.size() / 3); }
  void append(const Mesh& other);
};

/// Octahedron subdivided `times` times onto the unit sphere, stretched by the factors.
Mesh ellipsoid(int times, double x, double y, double z);

/// Torus around the z axis; `around` x `across` vertices.
Mesh torus(int around, int across, double ring_radius, double tube_radius);

/// Side of a cylinder along z, without the discs.
Mesh open_cylinder(int around, int along, double radius, double length);

/// Side of a cone along z, of height and radius 1: triangles around one vertex, the first.
Mesh cone(uint32_t triangles);

/// The zero set of `value` (negative inside) in the box of half-width `half`, closed inside the
/// box, as a manifold with one vertex per cell of a grid of `cells`^3 that the surface passes.
Mesh implicit_surface(const std::function<double(const Eigen::Vector3d&)>& value, double half,
                      int cells);

/// Distance to a segment minus the radius; the pieces of limbs.
double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               double radius);

/// Square 0 .. size in the plane z = 0, `cells` x `cells` squares of two triangles each; vertex (i,
/// j) has the index j (cells + 1) + i.
Mesh square(int cells, double size);

/// The mesh as one surface with adjacency; its vertices keep their indices.
Surface surface_of(const Mesh& mesh);

/// V - E + F of a mesh whose vertices are all used.
int euler_characteristic(const Mesh& mesh);

}  // namespace reeb::segmentation::shapes
