// Vertex normals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb {

/// Adds up the cross products of the triangles at each vertex, in binary64, and writes the unit
/// vectors of the sums to `normals + v * normal_stride`; (0, 0, 0) where a sum is zero or not
/// finite. `sums`: 3 * vertices values to work in.
void vertex_normals(std::span<const uint32_t> triangles, const float* positions, size_t stride,
                    std::span<double> sums, float* normals, size_t normal_stride);

}  // namespace reeb
