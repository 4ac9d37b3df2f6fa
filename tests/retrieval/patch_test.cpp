#include "retrieval/patch.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

#include "retrieval/charts.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::retrieval;
namespace shapes = reeb::segmentation::shapes;

namespace {

std::vector<uint32_t> first_triangles(size_t from, size_t to) {
  std::vector<uint32_t> list(to - from);
  std::iota(list.begin(), list.end(), static_cast<uint32_t>(from));
  return list;
}

std::vector<Patch> glue_all(const Surface& surface, size_t left_out = 0) {
  return glue(surface, first_triangles(left_out, surface.triangles.size()));
}

Surface surface_of(std::vector<Point> points, std::vector<Triple> triangles) {
  Surface surface;
  surface.points = std::move(points);
  surface.triangles = std::move(triangles);
  connect(surface);
  return surface;
}

// A band of quadrilaterals with a half turn in it.
Surface moebius_strip() {
  constexpr uint32_t kSteps = 12;
  std::vector<Point> points;
  std::vector<Triple> triangles;
  for (uint32_t i = 0; i < kSteps; ++i) {
    const double a = 2 * std::numbers::pi * i / kSteps;
    const Point middle(std::cos(a), std::sin(a), 0);
    const Point across = 0.3 * std::cos(a / 2) * middle + Point(0, 0, 0.3 * std::sin(a / 2));
    points.push_back(middle + across);
    points.push_back(middle - across);
  }
  for (uint32_t i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    triangles.push_back({a, b, c});
    triangles.push_back({b, d, c});
  }
  return surface_of(points, triangles);
}

}  // namespace

TEST_CASE("Patches have the topology of their surface", "[patch]") {
  const auto torus = glue_all(shapes::surface_of(shapes::torus(24, 12, 1, 0.4)));
  REQUIRE(torus.size() == 1);
  CHECK(torus[0].boundaries.empty());
  CHECK(torus[0].handles() == 2);
  const auto tube = glue_all(shapes::surface_of(shapes::open_cylinder(16, 8, 1, 3)));
  CHECK(tube[0].is_annulus());
  const auto square = glue_all(shapes::surface_of(shapes::square(5, 2)));
  CHECK(square[0].is_disc());
  CHECK(square[0].area == Approx(4));
  CHECK(square[0].boundaries[0].size() == 20);
  CHECK(loop_length(square[0].surface, square[0].boundaries[0]) == Approx(8));
  const auto strip = glue_all(moebius_strip());
  CHECK(strip[0].boundaries.size() == 1);
  CHECK(strip[0].handles() == 1);
}

TEST_CASE("An edge of three triangles joins none of them", "[patch]") {
  const Surface fins = surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}},
                                  {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  const auto patches = glue_all(fins);
  REQUIRE(patches.size() == 3);
  for (const Patch& patch : patches) CHECK(patch.is_disc());
}

TEST_CASE("Two fans at a vertex are taken apart", "[patch]") {
  const Surface bow = surface_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                                 {{0, 1, 2}, {0, 3, 4}});
  const auto patches = glue_all(bow);
  REQUIRE(patches.size() == 2);
  CHECK(patches[0].surface.vertex_count() == 3);
  CHECK(patches[1].surface.vertex_count() == 3);
}

TEST_CASE("Handles and crosscaps are cut until a disc is left", "[patch]") {
  const Surface torus = shapes::surface_of(shapes::torus(24, 12, 1, 0.4));
  for (const Patch& patch : {glue_all(torus, 1)[0], glue_all(moebius_strip())[0],
                             glue_all(shapes::surface_of(shapes::open_cylinder(16, 8, 1, 3)))[0]}) {
    CHECK_FALSE(patch.is_disc());
    const Patch disc = cut_to_disc(patch);
    CHECK(disc.is_disc());
    CHECK(disc.surface.triangles.size() == patch.surface.triangles.size());
    CHECK(disc.area == Approx(patch.area));
    CHECK(disc.original == patch.original);
  }
}

TEST_CASE("Capped boundaries add no area", "[patch]") {
  const auto tube = glue_all(shapes::surface_of(shapes::open_cylinder(16, 8, 1, 3)));
  const Patch half = cap_boundaries(tube[0], 1);
  CHECK(half.is_disc());
  CHECK(half.area == Approx(tube[0].area));
  CHECK(half.surface.triangles.size() == tube[0].surface.triangles.size() + 16);
  CHECK(cap_boundaries(tube[0], 0).euler_characteristic == 2);
}

TEST_CASE("Closed patches are halved", "[patch]") {
  const auto ball = glue_all(shapes::surface_of(shapes::ellipsoid(3, 1, 1, 3)));
  const auto halves = halve(ball[0]);
  REQUIRE(halves.size() == 2);
  CHECK(halves[0].is_disc());
  CHECK(halves[1].is_disc());
  CHECK(halves[0].area / ball[0].area == Approx(0.5).margin(0.05));
  const Surface pillow = surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  CHECK(halve(glue_all(pillow)[0]).size() == 2);
}

TEST_CASE("Charts are discs and annuli with neighbours", "[charts]") {
  // A cylinder in three parts: two tubes would touch the middle one alone.
  const Surface tube = shapes::surface_of(shapes::open_cylinder(24, 30, 1, 6));
  double low = 1e9;
  for (const Point& p : tube.points) low = std::min(low, p.z());
  std::vector<uint32_t> labels;
  for (const Point& p : tube.points)
    labels.push_back(static_cast<uint32_t>(std::min(2.0, (p.z() - low) / 2)));
  const Charts charts = cut_charts(tube, labels);
  REQUIRE(charts.patches.size() == 3);
  for (const Patch& patch : charts.patches) CHECK(patch.is_annulus());
  CHECK(charts.neighbours == std::vector<std::vector<uint32_t>>{{1}, {0, 2}, {1}});
}

TEST_CASE("Charts of any surface become discs or annuli and lose no area", "[charts]") {
  const auto two_holes = [](const Eigen::Vector3d& p) {
    const auto ring = [&](double x) {
      const double r = std::hypot(p.x() - x, p.y()) - 0.5;
      return std::hypot(r, p.z()) - 0.2;
    };
    return std::min(ring(-0.55), ring(0.55));
  };
  for (const auto& mesh :
       {shapes::torus(24, 12, 1, 0.4), shapes::ellipsoid(3, 1, 1, 1),
        shapes::open_cylinder(16, 8, 1, 3), shapes::implicit_surface(two_holes, 1.5, 40)}) {
    const Surface surface = shapes::surface_of(mesh);
    const Charts charts = cut_charts(surface, std::vector<uint32_t>(surface.vertex_count(), 0));
    double area = 0;
    for (const Patch& patch : charts.patches) {
      CHECK((patch.is_disc() || patch.is_annulus()));
      area += patch.area;
    }
    CHECK(area == Approx(total_area(surface)).epsilon(0.01));
  }
}

TEST_CASE("A small hole leaves a disc a disc", "[charts]") {
  Surface square = shapes::surface_of(shapes::square(20, 1));
  square.triangles.erase(square.triangles.begin() + 420, square.triangles.begin() + 422);
  connect(square);
  const Charts charts = cut_charts(square, std::vector<uint32_t>(square.vertex_count(), 0));
  REQUIRE(charts.patches.size() == 1);
  CHECK(charts.patches[0].is_disc());
}
