// Operator, eigenpairs, diffusion and curvature on surfaces with known answers.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "segmentation/curvature.h"
#include "segmentation/diffusion.h"
#include "segmentation/eigenpairs.h"
#include "segmentation/laplacian.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;
using std::numbers::pi;

namespace {

Surface triangle(const Point& a, const Point& b, const Point& c) {
  Surface surface;
  surface.points = {a, b, c};
  surface.triangles = {{0, 1, 2}};
  connect(surface);
  return surface;
}

// k_t(x, y) = sum_i exp(-lambda_i t) phi_i(x) phi_i(y)
double heat_kernel(const Eigenpairs& pairs, double t, uint32_t x, uint32_t y) {
  double sum = 0;
  for (Eigen::Index i = 0; i < pairs.values.size(); ++i) {
    sum += std::exp(-pairs.values[i] * t) * pairs.vectors(x, i) * pairs.vectors(y, i);
  }
  return sum;
}

}  // namespace

TEST_CASE("weights and areas of a right triangle") {
  const Laplacian laplacian = build_laplacian(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  // Half the cotangent of the opposite angle: 45, 45 and 90 degrees.
  CHECK(laplacian.stiffness.coeff(0, 1) == Approx(-0.5));
  CHECK(laplacian.stiffness.coeff(0, 2) == Approx(-0.5));
  CHECK(laplacian.stiffness.coeff(1, 2) == Approx(0).margin(1e-9));
  CHECK(laplacian.stiffness.coeff(0, 0) == Approx(1));
  // The bisectors meet in the middle of the long side.
  CHECK(laplacian.mass[0] == Approx(0.25));
  CHECK(laplacian.mass[1] == Approx(0.125));
  CHECK(laplacian.mass[2] == Approx(0.125));
}

TEST_CASE("an obtuse triangle gives half of its area to the obtuse corner") {
  const Laplacian laplacian = build_laplacian(triangle({0, 0, 0}, {3, 0, 0}, {-1, 1, 0}));
  CHECK(laplacian.mass[0] == Approx(0.75));
  CHECK(laplacian.mass[1] == Approx(0.375));
  CHECK(laplacian.mass[2] == Approx(0.375));
}

TEST_CASE("slivers and degenerate triangles leave the operator finite and semidefinite") {
  Surface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1e-9, 0}, {1, 1, 0}, {1, 1, 0}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}, {2, 4, 5}};
  connect(surface);
  const Laplacian laplacian = build_laplacian(surface);
  REQUIRE(laplacian.mass.allFinite());
  CHECK(laplacian.mass.minCoeff() > 0);
  const Eigen::MatrixXd full = laplacian.stiffness;
  REQUIRE(full.allFinite());
  CHECK((full * Eigen::VectorXd::Ones(6)).norm() < 1e-8 * full.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(full);
  CHECK(solver.eigenvalues()[0] > -1e-9 * solver.eigenvalues()[5]);
}

TEST_CASE("eigenvalues of the unit sphere are l (l + 1)") {
  const Surface sphere = shapes::surface_of(shapes::ellipsoid(5, 1, 1, 1));
  const Laplacian laplacian = build_laplacian(sphere);
  CHECK(laplacian.mass.sum() == Approx(4 * pi).epsilon(0.005));
  const Eigenpairs pairs = smallest_eigenpairs(laplacian, 16);
  REQUIRE(pairs.values.size() == 16);
  int i = 0;
  for (int l = 0; l < 4; ++l) {
    for (int m = -l; m <= l; ++m, ++i) {
      CHECK(pairs.values[i] == Approx(l * (l + 1)).epsilon(0.01).margin(1e-6));
    }
  }
  const Eigen::MatrixXd products =
      pairs.vectors.transpose() * laplacian.mass.asDiagonal() * pairs.vectors;
  CHECK((products - Eigen::MatrixXd::Identity(16, 16)).norm() < 1e-6);
}

TEST_CASE("eigenvalues of a square with free boundary, by either solver") {
  for (const int cells : {10, 40}) {  // 121 vertices are solved densely
    const Laplacian laplacian = build_laplacian(shapes::surface_of(shapes::square(cells, pi)));
    const Eigenpairs pairs = smallest_eigenpairs(laplacian, 6);
    REQUIRE(pairs.values.size() == 6);
    const double expected[] = {0, 1, 1, 2, 4, 4};  // m^2 + n^2
    for (int i = 0; i < 6; ++i) {
      CHECK(pairs.values[i] == Approx(expected[i]).epsilon(0.04).margin(1e-6));
    }
  }
}

TEST_CASE("a surface of few vertices has as many eigenpairs") {
  const Surface sphere = shapes::surface_of(shapes::ellipsoid(0, 1, 1, 1));
  CHECK(smallest_eigenpairs(build_laplacian(sphere), 60).values.size() == 6);
}

TEST_CASE("diffusion distance and heat kernel belong together") {
  const Surface surface = shapes::surface_of(shapes::ellipsoid(3, 1, 1, 3));
  const Eigenpairs pairs = smallest_eigenpairs(build_laplacian(surface), 30);
  const double t = 0.2;
  const Eigen::VectorXd distance = distances_from(diffusion_embedding(pairs, t), 5);
  CHECK(heat_kernel(pairs, t, 5, 77) == Approx(heat_kernel(pairs, t, 77, 5)));
  for (const uint32_t y : {5u, 6u, 77u, 200u}) {
    const double squared = heat_kernel(pairs, 2 * t, 5, 5) + heat_kernel(pairs, 2 * t, y, y) -
                           2 * heat_kernel(pairs, 2 * t, 5, y);
    CHECK(distance[y] == Approx(std::sqrt(std::max(squared, 0.0))).margin(1e-6));
  }
  // The heat stays: integrated over the surface the kernel is 1.
  const Laplacian laplacian = build_laplacian(surface);
  double heat = 0;
  for (uint32_t y = 0; y < surface.vertex_count(); ++y) {
    heat += laplacian.mass[y] * heat_kernel(pairs, t, 5, y);
  }
  CHECK(heat == Approx(1).epsilon(1e-6));
}

TEST_CASE("the distance function is 0 at its sources and 1 at the farthest vertex") {
  Eigen::MatrixXd embedding(1, 5);
  embedding << 0, 1, 3, 6, 10;
  const Eigen::VectorXd f = distance_function(embedding, {0, 3});
  CHECK(f[0] == 0);
  CHECK(f[1] == Approx(0.25));
  CHECK(f[2] == Approx(0.75));
  CHECK(f[3] == 0);
  CHECK(f[4] == 1);
}

TEST_CASE("the smaller curvature of a sphere and of a torus, whichever way the triangles turn") {
  for (const bool flipped : {false, true}) {
    shapes::Mesh sphere = shapes::ellipsoid(4, 2, 2, 2), torus = shapes::torus(80, 40, 2, 0.5);
    for (shapes::Mesh* mesh : {&sphere, &torus}) {
      for (size_t t = 0; flipped && t < mesh->triangles.size(); t += 3) {
        std::swap(mesh->triangles[t], mesh->triangles[t + 1]);
      }
    }
    const Surface ball = shapes::surface_of(sphere), ring = shapes::surface_of(torus);
    const Eigen::VectorXd on_ball = minimal_curvature(ball, build_laplacian(ball), 2);
    CHECK(on_ball.minCoeff() > 0.4);
    CHECK(on_ball.maxCoeff() < 0.55);
    const Eigen::VectorXd on_ring = minimal_curvature(ring, build_laplacian(ring), 1);
    CHECK(on_ring[20] == Approx(-1 / 1.5).epsilon(0.1));  // inner equator
    CHECK(on_ring[0] == Approx(1 / 2.5).epsilon(0.1));    // outer equator
  }
}

TEST_CASE("triangles of mixed orientation have no curvature") {
  shapes::Mesh mesh = shapes::ellipsoid(3, 1, 1, 1);
  for (size_t t = 0; t < mesh.triangles.size(); t += 6) {
    std::swap(mesh.triangles[t], mesh.triangles[t + 1]);
  }
  const Surface surface = shapes::surface_of(mesh);
  CHECK(minimal_curvature(surface, build_laplacian(surface), 1).isZero());
}
