#include "retrieval/descriptors.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "retrieval/thickness.h"
#include "segmentation/laplacian.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::retrieval;
namespace shapes = reeb::segmentation::shapes;

namespace {

PieceSpectrum spectrum_of(const Surface& surface) {
  const auto laplacian = build_laplacian(surface);
  return {smallest_eigenpairs(laplacian, 60), laplacian.mass};
}

}  // namespace

TEST_CASE("Quantiles weigh values", "[descriptors]") {
  CHECK(quantiles({{3, 1}, {1, 1}, {2, 2}}, 4) == std::vector<double>{1, 2, 2, 3});
  CHECK(quantiles({{5, 9}, {7, 1}}, 1) == std::vector<double>{5});
  CHECK(quantiles({}, 2) == std::vector<double>{0, 0});
}

TEST_CASE("Heat and wave signatures of a sphere are those of spherical harmonics",
          "[descriptors]") {
  const Surface sphere = shapes::surface_of(shapes::ellipsoid(4, 1, 1, 1));
  const std::vector<PieceSpectrum> pieces{spectrum_of(sphere)};
  const double area = total_area(sphere);
  const auto heat = heat_quantiles(pieces, area);
  const auto wave = wave_quantiles(pieces, area);
  REQUIRE(heat.size() == size_t{kScales * kQuantiles});
  // Eigenvalue l (l + 1), 2 l + 1 times, of area 4 pi; the square sum of each is constant.
  for (int s = 5; s < kScales; ++s) {  // earlier ones need more than 60 eigenvectors
    double expected = 0;
    for (int l = 0; l < 20; ++l)
      expected += (2 * l + 1) *
                  std::exp(-l * (l + 1) * 4 * std::numbers::pi * 0.0006 * std::pow(1.7783, s));
    for (int q = 0; q < kQuantiles; ++q)
      CHECK(heat[s * kQuantiles + q] == Approx(std::log(expected)).margin(0.02));
  }
  // Whatever the energy, a mean of phi^2 area, which is 1 here where whole multiplets take part.
  for (int s = 0; s < kScales - 3; ++s) {
    for (int q = 0; q < kQuantiles; ++q) CHECK(wave[s * kQuantiles + q] == Approx(0).margin(0.05));
  }
}

TEST_CASE("Thickness of a ball and of tubes is their radius", "[descriptors]") {
  for (const double t : local_thickness(shapes::surface_of(shapes::ellipsoid(4, 2, 2, 2)), 5))
    CHECK(t == Approx(2).epsilon(0.06));
  for (const double t : local_thickness(shapes::surface_of(shapes::torus(60, 30, 3, 0.5)), 2))
    CHECK(t == Approx(0.5).epsilon(0.03));
  // Nothing is opposite of a flat sheet.
  for (const double t : local_thickness(shapes::surface_of(shapes::square(10, 1)), 0.3))
    CHECK(t == 0.3);
}

TEST_CASE("Curvature is that of spheres and tori, whichever way their triangles turn",
          "[descriptors]") {
  const auto range = [](const shapes::Mesh& mesh, const Point& centre) {
    const Surface surface = shapes::surface_of(mesh);
    const auto found = curvatures(surface, build_laplacian(surface), centre, 3);
    const auto [low, high] = std::minmax_element(found.begin(), found.end());
    return std::pair(std::sinh(low->first) / 3, std::sinh(high->first) / 3);
  };
  shapes::Mesh ball = shapes::ellipsoid(4, 2, 2, 2);
  for (int turn = 0; turn < 2; ++turn) {
    const auto [low, high] = range(ball, {0.5, 0, 0});
    CHECK(low == Approx(0.5).epsilon(0.03));
    CHECK(high == Approx(0.5).epsilon(0.03));
    std::reverse(ball.triangles.begin(), ball.triangles.end());
  }
  // (R + 2 r cos) / (2 r (R + r cos)): concave at the inner equator.
  const auto [inner, outer] = range(shapes::torus(200, 130, 3, 2), {0, 0, 0});
  CHECK(inner == Approx(-0.25).epsilon(0.02));
  CHECK(outer == Approx(0.35).epsilon(0.02));
}

TEST_CASE("A sphere reaches as far everywhere from the centre of its area", "[descriptors]") {
  shapes::Mesh ball = shapes::ellipsoid(3, 2, 2, 2);
  for (size_t i = 0; i < ball.positions.size(); i += 3) ball.positions[i] += 7;
  const std::vector<Surface> surfaces{shapes::surface_of(ball)};
  const Point centre = area_centre(surfaces);
  CHECK((centre - Point(7, 0, 0)).norm() < 1e-5);
  for (const auto& [reach, area] :
       reaches(surfaces[0], build_laplacian(surfaces[0]).mass, centre, 4))
    CHECK(reach == Approx(std::log(0.5)).margin(1e-5));
  CHECK(
      reaches(surfaces[0], build_laplacian(surfaces[0]).mass, surfaces[0].points[0], 4)[0].first ==
      Approx(std::log(0.02)));  // no logarithm of 0
}

TEST_CASE("A rod is straight, and a ring is not", "[descriptors]") {
  const auto middle = [](const Surface& surface) {
    return quantiles(straightness(surface, build_laplacian(surface).mass), 1)[0];
  };
  CHECK(middle(shapes::surface_of(shapes::open_cylinder(12, 80, 0.1, 8))) > 0.97);
  // On a ring of radius 1 points at x along it lie 2 sin(x / 2) apart. Weighted by x, the middle
  // one of 0 .. pi is at pi / sqrt(2).
  const double x = std::numbers::pi / std::numbers::sqrt2;
  CHECK(middle(shapes::surface_of(shapes::torus(200, 12, 3, 0.1))) ==
        Approx(2 * std::sin(x / 2) / x).epsilon(0.04));
}
