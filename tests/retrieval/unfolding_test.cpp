#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "retrieval/stretch.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::retrieval;
namespace shapes = reeb::segmentation::shapes;

namespace {

Patch patch_of(const shapes::Mesh& mesh) {
  const Surface surface = shapes::surface_of(mesh);
  std::vector<uint32_t> all(surface.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return glue(surface, all)[0];
}

Rings rings_of(const Patch& patch) {
  Unfolding unfolding;
  REQUIRE(unfold(patch, unfolding));
  return measure_rings(patch, unfolding, std::vector<double>(patch.original.size(), 7.0));
}

// Polar grid over a part of a surface of revolution: radius and height by the angle from the pole.
template <typename Profile>
shapes::Mesh revolved(int around, int along, Profile profile) {
  shapes::Mesh mesh;
  const auto add = [&](double x, double y, double z) {
    for (const double c : {x, y, z}) mesh.positions.push_back(static_cast<float>(c));
  };
  add(0, 0, profile(0.0).second);
  for (int j = 1; j <= along; ++j) {
    const auto [radius, height] = profile(static_cast<double>(j) / along);
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * (i + 0.5 * (j % 2)) / around;
      add(radius * std::cos(a), radius * std::sin(a), height);
    }
  }
  const auto at = [&](int j, int i) {
    return static_cast<uint32_t>(1 + (j - 1) * around + i % around);
  };
  for (int i = 0; i < around; ++i)
    for (const uint32_t v : {0u, at(1, i), at(1, i + 1)}) mesh.triangles.push_back(v);
  for (int j = 1; j < along; ++j) {
    for (int i = 0; i < around; ++i) {
      // Odd rings are turned by half a step.
      const uint32_t a = at(j, i), b = at(j, i + 1);
      const uint32_t c = at(j + 1, j % 2 == 1 ? i : i), d = at(j + 1, i + 1);
      if (j % 2 == 1) {
        for (const uint32_t v : {a, d, b, a, c, d}) mesh.triangles.push_back(v);
      } else {
        for (const uint32_t v : {a, c, b, b, c, d}) mesh.triangles.push_back(v);
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("A cylinder unrolls without stretch", "[unfolding]") {
  constexpr int kAround = 20;
  const double girth = 2 * kAround * std::sin(std::numbers::pi / kAround);  // of the prism
  for (const double length : {0.5, 4.0}) {
    const Patch tube = patch_of(shapes::open_cylinder(kAround, 15, 1, length));
    Unfolding unfolding;
    REQUIRE(unfold(tube, unfolding));
    CHECK(unfolding.height == Approx(length / girth).epsilon(1e-5));
    const Rings rings = rings_of(tube);
    for (int r = 0; r < kRings; ++r) {
      CHECK(rings.area[r] == Approx(0).margin(1e-4));
      CHECK(rings.angle[r] == Approx(0).margin(1e-3));
      CHECK(rings.value[r] == Approx(7));
    }
  }
}

TEST_CASE("A frustum of a cone has the modulus of its development", "[unfolding]") {
  // Unrolled, an annulus of radii 1 and 3 in slant length and an opening angle of 2 pi sin(half
  // angle): the modulus is log(3) / that angle.
  const double slope = 0.3;  // radius per slant length
  auto mesh = shapes::open_cylinder(96, 96, 1, 1);
  float low = 1e9f, high = -1e9f;
  for (size_t i = 2; i < mesh.positions.size(); i += 3) {
    low = std::min(low, mesh.positions[i]);
    high = std::max(high, mesh.positions[i]);
  }
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const double slant = 1 + 2 * (mesh.positions[i + 2] - low) / (high - low);
    mesh.positions[i] *= static_cast<float>(slope * slant);
    mesh.positions[i + 1] *= static_cast<float>(slope * slant);
    mesh.positions[i + 2] = static_cast<float>(std::sqrt(1 - slope * slope) * slant);
  }
  const Patch frustum = patch_of(mesh);
  Unfolding unfolding;
  REQUIRE(unfold(frustum, unfolding));
  CHECK(unfolding.height == Approx(std::log(3.0) / (2 * std::numbers::pi * slope)).epsilon(0.005));
  // From the longer boundary on: at slant s the area beyond is (9 - s^2) / 8 of the whole and the
  // part of the height log(3 / s) / log 3.
  const Rings rings = rings_of(frustum);
  for (int r = 0; r < kRings; ++r) {
    const auto height = [](double part) {
      return std::log(3 / std::sqrt(9 - 8 * part)) / std::log(3.0);
    };
    const double expected = kRings * (height((r + 1.0) / kRings) - height(r / double{kRings}));
    CHECK(rings.area[r] == Approx(std::log(expected)).margin(0.03));
    CHECK(rings.angle[r] < 0.06);
  }
}

TEST_CASE("A bent tube has the modulus of a torus", "[unfolding]") {
  // On a torus of radii 3 and 1 the conformal measure around is integral d theta / (3 + cos theta)
  // = 2 pi / sqrt(8), that along is the angle: half a turn here.
  auto mesh = shapes::open_cylinder(96, 150, 1, 1);
  float low = 1e9f, high = -1e9f;
  for (size_t i = 2; i < mesh.positions.size(); i += 3) {
    low = std::min(low, mesh.positions[i]);
    high = std::max(high, mesh.positions[i]);
  }
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const double turn = std::numbers::pi * (mesh.positions[i + 2] - low) / (high - low);
    const double reach = 3 + mesh.positions[i];
    mesh.positions[i] = static_cast<float>(reach * std::cos(turn));
    mesh.positions[i + 2] = static_cast<float>(reach * std::sin(turn));
  }
  const Patch tube = patch_of(mesh);
  Unfolding unfolding;
  REQUIRE(unfold(tube, unfolding));
  CHECK(unfolding.height == Approx(std::sqrt(8.0) / 2).epsilon(0.003));
  const Rings rings = rings_of(tube);
  for (int r = 0; r < kRings; ++r) {
    CHECK(rings.area[r] == Approx(0).margin(0.01));
    CHECK(rings.angle[r] < 0.06);
  }
}

TEST_CASE("A flat disc unfolds to itself", "[unfolding]") {
  const Patch disc = patch_of(revolved(24, 12, [](double t) { return std::pair(2 * t, 0.0); }));
  const Rings rings = rings_of(disc);
  for (int r = 0; r < kRings; ++r) {
    CHECK(rings.area[r] == Approx(0).margin(1e-4));
    CHECK(rings.angle[r] == Approx(0).margin(1e-3));
  }
}

TEST_CASE("A cap of a sphere unfolds by stereographic projection", "[unfolding]") {
  const double rim = 2.0;  // radians from the pole
  const Patch cap = patch_of(
      revolved(64, 64, [&](double t) { return std::pair(std::sin(rim * t), std::cos(rim * t)); }));
  const Rings rings = rings_of(cap);
  const auto plane_part = [&](double surface_part) {
    const double c = 1 - surface_part * (1 - std::cos(rim));
    return (1 - c) / (1 + c) * (1 + std::cos(rim)) / (1 - std::cos(rim));
  };
  for (int r = 0; r < kRings; ++r) {
    const double expected =
        kRings * (plane_part((r + 1.0) / kRings) - plane_part(r / double{kRings}));
    CHECK(rings.area[r] == Approx(std::log(expected)).margin(0.03));
    CHECK(rings.angle[r] < 0.08);
  }
}

TEST_CASE("Obtuse triangles do not fold", "[unfolding]") {
  // A disc squeezed to a twentieth: cotangent weights alone are far below 0.
  auto mesh = revolved(12, 6, [](double t) { return std::pair(t, 0.3 * t * t); });
  for (size_t i = 0; i < mesh.positions.size(); i += 3) mesh.positions[i] *= 0.05f;
  const Patch patch = patch_of(mesh);
  Unfolding unfolding;
  REQUIRE(unfold(patch, unfolding));
  double area = 0, signed_area = 0;
  for (const auto& c : unfolding.corners) {
    const Eigen::Vector2d p = c.col(1) - c.col(0), q = c.col(2) - c.col(0);
    signed_area += p.x() * q.y() - p.y() * q.x();
    area += std::abs(p.x() * q.y() - p.y() * q.x());
  }
  CHECK(std::abs(signed_area) == Approx(area));
}
