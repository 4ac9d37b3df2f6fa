#include "segmentation/surface.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "segmentation/nearest.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;

TEST_CASE("grouping by owner lists members in order and skips those without one") {
  const std::vector<uint32_t> owner = {2, 0, kNone, 2, 0};
  const Rows rows = group_by(owner, 3);
  CHECK(std::vector(rows[0].begin(), rows[0].end()) == std::vector<uint32_t>{1, 4});
  CHECK(rows[1].empty());
  CHECK(std::vector(rows[2].begin(), rows[2].end()) == std::vector<uint32_t>{0, 3});
}

TEST_CASE("a tetrahedron has six edges of two triangles") {
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<uint32_t> triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const Pieces pieces = split_pieces(positions, triangles, true);
  REQUIRE(pieces.surfaces.size() == 1);
  const Surface& surface = pieces.surfaces[0];
  REQUIRE(surface.edges.size() == 6);
  for (uint32_t e = 0; e < 6; ++e) CHECK(surface.edge_triangles[e].size() == 2);
  for (uint32_t v = 0; v < 4; ++v) {
    CHECK(surface.vertex_edges[v].size() == 3);
    CHECK(surface.vertex_triangles[v].size() == 3);
  }
  for (uint32_t t = 0; t < 4; ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const Edge e = surface.edges[surface.triangle_edges[t][i]];
      const auto [low, high] =
          std::minmax(surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]);
      CHECK((e.a == low && e.b == high));
    }
  }
  // Three right triangles with legs of 1 and one equilateral with sides of sqrt 2.
  CHECK(total_area(surface) == Approx(1.5 + std::sqrt(3.0) / 2));
}

TEST_CASE("distances along edges stop at the radius") {
  const Surface surface = shapes::surface_of(shapes::square(4, 4));
  const std::vector<double> distance = edge_distances(surface, 0, 2.5);
  CHECK(distance[2] == 2);                       // along the lower side
  CHECK(distance[6] == Approx(std::sqrt(2.0)));  // across the first diagonal
  CHECK(distance[7] == Approx(1 + std::sqrt(2.0)));
  CHECK(std::isinf(distance[3]));
}

TEST_CASE("a mesh is split into pieces and keeps track of its vertices") {
  // Two triangles apart, an unused vertex between them, and one triangle out of range.
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9,
                                        9, 5, 0, 0, 6, 0, 0, 5, 1, 0};
  const std::vector<uint32_t> triangles = {4, 5, 6, 0, 1, 2, 0, 1, 7, 1, 1, 2};
  const Pieces pieces = split_pieces(positions, triangles, true);
  REQUIRE(pieces.surfaces.size() == 2);
  CHECK(pieces.original[0] == std::vector<uint32_t>{0, 1, 2});
  CHECK(pieces.original[1] == std::vector<uint32_t>{4, 5, 6});
  CHECK(pieces.piece == std::vector<uint32_t>{0, 0, 0, kNone, 1, 1, 1});
  CHECK(pieces.local[6] == 2);
  CHECK(pieces.ignored_triangles == 2);
}

TEST_CASE("only boundary vertices are welded") {
  SECTION("two triangles side by side with doubled corners become one piece") {
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::vector<uint32_t> triangles = {0, 1, 2, 3, 5, 4};
    CHECK(split_pieces(positions, triangles, false).surfaces.size() == 2);
    const Pieces pieces = split_pieces(positions, triangles, true);
    REQUIRE(pieces.surfaces.size() == 1);
    CHECK(pieces.surfaces[0].vertex_count() == 4);
    CHECK(pieces.local[3] == pieces.local[1]);
  }
  SECTION("two spheres that touch in a vertex stay apart") {
    shapes::Mesh mesh = shapes::ellipsoid(2, 1, 1, 1), other = mesh;
    for (size_t i = 0; i < other.positions.size(); i += 3) other.positions[i] += 2;
    mesh.append(other);
    CHECK(split_pieces(mesh.positions, mesh.triangles, true).surfaces.size() == 2);
  }
}

TEST_CASE("triangles with a vertex that is not finite are ignored") {
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, infinite, 1};
  const Pieces pieces = split_pieces(positions, std::vector<uint32_t>{0, 1, 2, 0, 1, 3}, true);
  REQUIRE(pieces.surfaces.size() == 1);
  CHECK(pieces.surfaces[0].triangles.size() == 1);
  CHECK(pieces.piece[3] == kNone);
}

TEST_CASE("the nearest point is that of an exhaustive search") {
  const shapes::Mesh torus = shapes::torus(13, 7, 2, 0.7), sphere = shapes::ellipsoid(2, 3, 2, 1);
  const std::vector<Point> points = shapes::surface_of(torus).points;
  const NearestPoint nearest(points);
  for (const Point& query : shapes::surface_of(sphere).points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Point& p : points) least = std::min(least, (p - query).norm());
    CHECK((points[nearest.find(query)] - query).norm() == least);
  }
}
