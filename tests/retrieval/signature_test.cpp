#include "retrieval/signature.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>

#include "retrieval/shape_distance.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::retrieval;
namespace shapes = reeb::segmentation::shapes;

namespace {

Signed sign_mesh(const shapes::Mesh& mesh) { return sign(mesh.positions, mesh.triangles); }

// A body with `limbs` limbs.
shapes::Mesh star(int limbs, double reach) {
  return shapes::implicit_surface(
      [=](const Eigen::Vector3d& p) {
        double d = p.norm() - 0.15;
        for (int i = 0; i < limbs; ++i) {
          const double a = 2 * M_PI * i / limbs;
          d = std::min(d,
                       shapes::capsule(p, Eigen::Vector3d::Zero(),
                                       reach * Eigen::Vector3d(std::cos(a), std::sin(a), 0), 0.12));
        }
        return d;
      },
      1.3, 48);
}

}  // namespace

TEST_CASE("Limbs are discs of equal size", "[signature]") {
  const Signed result = sign_mesh(star(5, 1));
  CHECK(result.warnings.empty());
  int limbs = 0;
  double share = 0;
  for (const ChartSignature& chart : result.signature.charts) {
    limbs += !chart.annulus && chart.share > 0.08 && chart.share < 0.25;
    share += chart.share;
  }
  CHECK(limbs == 5);
  CHECK(share == Approx(1).margin(0.03));
}

TEST_CASE("A signature does not mind how a shape is turned, scaled and numbered", "[signature]") {
  shapes::Mesh mesh = star(4, 1);
  const Signature before = sign_mesh(mesh).signature;
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const float x = mesh.positions[i], y = mesh.positions[i + 1];
    mesh.positions[i] = 20 * (0.6f * x - 0.8f * y) + 5;
    mesh.positions[i + 1] = 20 * (0.8f * x + 0.6f * y);
    mesh.positions[i + 2] *= 20;
  }
  const Signature moved = sign_mesh(mesh).signature;
  const Signature other = sign_mesh(star(6, 0.8)).signature;
  CHECK(shape_distance(before, moved).total < 0.15 * shape_distance(before, other).total);
}

TEST_CASE("Any mesh is signed, or not, with a word", "[signature][hostile]") {
  SECTION("degenerate triangles") {
    const Signed result =
        sign(std::vector<float>(300, 1.0f), std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
    CHECK(result.signature.empty());
    CHECK_FALSE(result.warnings.empty());
  }
  SECTION("a point cloud") {
    std::vector<float> points;
    for (int i = 0; i < 3000; ++i) points.push_back(std::sin(static_cast<float>(i * i)));
    CHECK(sign(points, {}).signature.empty());
  }
  SECTION("nothing") { CHECK(sign({}, {}).signature.empty()); }
  SECTION("not a number, out of range") {
    const std::vector<float> points{0, 0, 0, NAN, 0, 0, 0, INFINITY, 0};
    CHECK(sign(points, std::vector<uint32_t>{0, 1, 2, 0, 1, 9}).signature.empty());
  }
  SECTION("30,000 components") {
    shapes::Mesh dust;
    for (int i = 0; i < 30000; ++i) {
      shapes::Mesh tetrahedron;
      const float x = static_cast<float>(i % 200), y = static_cast<float>(i / 200);
      tetrahedron.positions = {x, y, 0, x + 0.5f, y, 0, x, y + 0.5f, 0, x, y, 0.5f};
      tetrahedron.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
      dust.append(tetrahedron);
    }
    const auto start = std::chrono::steady_clock::now();
    const Signed result = sign_mesh(dust);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
    CHECK(result.signature.empty());
    CHECK_FALSE(result.warnings.empty());
  }
}

TEST_CASE("Signatures come back from their bytes", "[signature]") {
  const Signature signature = sign_mesh(star(3, 1)).signature;
  const std::vector<uint8_t> bytes = to_bytes(signature);
  Signature back;
  REQUIRE(from_bytes(bytes, back));
  CHECK(to_bytes(back) == bytes);
  REQUIRE(back.charts.size() == signature.charts.size());
  CHECK(back.charts[0].neighbours == signature.charts[0].neighbours);
  for (size_t i = 0; i < back.wave.size(); ++i)
    CHECK(back.wave[i] == Approx(signature.wave[i]).margin(0.0005));
  CHECK(shape_distance(signature, back).total < 0.01);
  REQUIRE(from_bytes(to_bytes({}), back));
  CHECK(back.empty());
}

TEST_CASE("Broken bytes are refused or harmless", "[signature][hostile]") {
  const std::vector<uint8_t> bytes = to_bytes(sign_mesh(star(3, 1)).signature);
  Signature out;
  for (size_t length = 0; length < bytes.size(); ++length)
    CHECK_FALSE(from_bytes(std::span(bytes).first(length), out));
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  CHECK_FALSE(from_bytes(longer, out));
  Signature whole;
  REQUIRE(from_bytes(bytes, whole));
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (const int mask : {1, 0x80, 0xff}) {
      std::vector<uint8_t> broken = bytes;
      broken[i] = static_cast<uint8_t>(broken[i] ^ mask);
      if (from_bytes(broken, out) && !out.empty())
        CHECK(std::isfinite(shape_distance(whole, out).total));
    }
  }
}
