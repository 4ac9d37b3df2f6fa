// The order in which PCA coefficients travel over the mesh, and what predicts each.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb::conformance {

/// Vertices in the order of coding, each with the parallelograms that end in it and lie before it.
struct Traversal {
  using Parallelogram = std::array<uint32_t, 3>;  ///< a, b, c: the vertex lies near a + b - c

  std::vector<uint32_t> order;                ///< every vertex once
  std::vector<uint32_t> parallelogram_begin;  ///< per place in `order`, one more at the end
  std::vector<Parallelogram> parallelograms;
  std::vector<uint32_t> neighbour_begin;  ///< the same for neighbours coded before
  std::vector<uint32_t> neighbours;
};

/// Breadth first over triangles that share edges, component after component; vertices without a
/// triangle come last.
Traversal traverse(std::span<const uint32_t> triangles, uint32_t vertex_count);

}  // namespace reeb::conformance
