// Texture coordinates and normals of surfaces that are put together of limbs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/sample/isosurface.h"

namespace reeb::tools {

/// A limb that part of the surface is rolled off from.
struct UnwrapAxis {
  Vec3 from, to;
};

/// Two coordinates for each corner, in [0, 1]: every axis has a tile of its own, along it in v and
/// around it in u. There are seams between the axes and along each. `axis_of`: of each triangle.
std::vector<float> unwrap(const TriangleMesh& mesh, std::span<const UnwrapAxis> axes,
                          std::span<const size_t> axis_of);

/// Three numbers for each corner, appended: the normal of the triangle where it is faceted, else
/// the mean by area of those around the vertex that are not. `positions`: xyz of the vertices.
void append_normals(const TriangleMesh& mesh, std::span<const uint8_t> faceted,
                    std::span<const float> positions, std::vector<float>& out);

}  // namespace reeb::tools
