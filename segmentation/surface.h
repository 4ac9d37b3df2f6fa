// Connected pieces of a triangle mesh with the adjacency that the segmentation walks on.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb::segmentation {

inline constexpr uint32_t kNone = 0xffffffffu;

using Point = Eigen::Vector3d;
using Triple = std::array<uint32_t, 3>;

/// Rows of different length in one array.
struct Rows {
  std::vector<uint32_t> start;  ///< first item of each row, one more at the end
  std::vector<uint32_t> items;
  std::span<const uint32_t> operator[](uint32_t row) const {
    return {items.data() + start[row], items.data() + start[row + 1]};
  }
};

/// Groups 0 .. owner.size()-1 by owner: row r lists, ascending, the i with owner[i] == r < rows. An
/// owner of kNone belongs to no row.
Rows group_by(std::span<const uint32_t> owner, uint32_t rows);

struct Edge {
  uint32_t a, b;  ///< a < b
};

/// A triangle mesh with its edges; manifold or not, with or without boundary.
struct Surface {
  std::vector<Point> points;
  std::vector<Triple> triangles;  ///< three different vertices each
  std::vector<Edge> edges;        ///< sorted by (a, b)
  std::vector<Triple> triangle_edges;
  Rows vertex_edges, vertex_triangles, edge_triangles;

  uint32_t vertex_count() const { return static_cast<uint32_t>(points.size()); }
  uint32_t opposite(uint32_t edge, uint32_t vertex) const {
    return edges[edge].a == vertex ? edges[edge].b : edges[edge].a;
  }
  double edge_length(uint32_t edge) const {
    return (points[edges[edge].a] - points[edges[edge].b]).norm();
  }
};

bool finite_at(std::span<const float> positions, uint32_t v);

/// Fills edges and adjacency of `surface` from its points and triangles.
void connect(Surface& surface);

double triangle_area(const Surface& surface, uint32_t triangle);
double total_area(const Surface& surface);

/// Distance along edges from `source` to every vertex, infinity beyond `radius`.
std::vector<double> edge_distances(const Surface& surface, uint32_t source, double radius);

/// A mesh taken apart into its connected pieces.
struct Pieces {
  std::vector<Surface> surfaces;  ///< in order of their lowest vertex
  std::vector<uint32_t> piece;    ///< per input vertex, kNone when no usable triangle has it
  std::vector<uint32_t> local;    ///< per input vertex, its index within its piece
  std::vector<std::vector<uint32_t>>
      original;  ///< per piece and local vertex, the lowest input vertex
  uint32_t ignored_triangles =
      0;  ///< index out of range or repeated, no extent, or a vertex not finite
};

/// Splits a mesh; `weld` makes boundary vertices of equal position one.
Pieces split_pieces(std::span<const float> positions, std::span<const uint32_t> triangles,
                    bool weld);

}  // namespace reeb::segmentation
