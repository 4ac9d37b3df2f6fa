#include "retrieval/signature.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <map>

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

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

bool finite(const Signed& result) {
  if (result.signature.empty()) return !result.warnings.empty();
  const ShapeDistance d = shape_distance(result.signature, result.signature);
  return d.total == Approx(0).margin(1e-9);
}

shapes::Mesh tetrahedron(int column, int row) {
  const auto x = static_cast<float>(column), y = static_cast<float>(row);
  return {{x, y, 0, x + 0.5f, y, 0, x, y + 0.5f, 0, x, y, 0.5f},
          {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}};
}

// A plate of cubes with `holes` x `holes` square holes.
shapes::Mesh pierced_plate(int holes) {
  const int side = 2 * holes + 1;
  const auto solid = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && x < side && y < side && z == 0 && !(x % 2 == 1 && y % 2 == 1);
  };
  shapes::Mesh mesh;
  std::map<std::array<int, 3>, uint32_t> number;
  const auto corner = [&](std::array<int, 3> at) {
    const auto [found, added] = number.try_emplace(at, static_cast<uint32_t>(number.size()));
    if (added) {
      for (const int x : at) mesh.positions.push_back(static_cast<float>(x));
    }
    return found->second;
  };
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int axis = 0; axis < 3 && solid(x, y, 0); ++axis) {
        for (const int ahead : {0, 1}) {
          std::array<int, 3> beyond{x, y, 0}, at{x, y, 0};
          beyond[axis] += 2 * ahead - 1;
          if (solid(beyond[0], beyond[1], beyond[2])) continue;
          at[axis] += ahead;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<uint32_t, 4> around{};
          for (int i = 0; i < 4; ++i) {
            std::array<int, 3> c = at;
            c[u] += i == 1 || i == 2;
            c[v] += i >= 2;
            around[ahead == 1 ? i : 3 - i] = corner(c);
          }
          for (const int i : {0, 1, 2, 0, 2, 3}) mesh.triangles.push_back(around[i]);
        }
      }
    }
  }
  return mesh;
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
  shapes::Mesh large = mesh;
  for (float& x : large.positions) x *= 64;  // without rounding
  CHECK(to_bytes(sign_mesh(large).signature) == to_bytes(before));
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const float x = mesh.positions[i], y = mesh.positions[i + 1];
    mesh.positions[i] = 20 * (0.6f * x - 0.8f * y) + 5;
    mesh.positions[i + 1] = 20 * (0.8f * x + 0.6f * y);
    mesh.positions[i + 2] *= 20;
  }
  const Signature moved = sign_mesh(mesh).signature;
  const Signature other = sign_mesh(star(6, 0.8)).signature;
  shapes::Mesh renumbered = large;
  for (size_t v = 0; v < large.vertex_count(); ++v)
    std::copy_n(&large.positions[3 * v], 3,
                &renumbered.positions[3 * (large.vertex_count() - 1 - v)]);
  std::reverse(renumbered.triangles.begin(), renumbered.triangles.end());
  for (uint32_t& v : renumbered.triangles) v = large.vertex_count() - 1 - v;
  const Signature other_order = sign_mesh(renumbered).signature;
  const double unlike = shape_distance(before, other).total;
  CHECK(match_charts(before, moved).distance < 0.01);
  CHECK(shape_distance(before, moved).total < 0.02 * unlike);
  // Of equal limbs the numbering tells where cuts begin.
  CHECK(match_charts(before, other_order).distance < 0.15);
  CHECK(shape_distance(before, other_order).total < 0.15 * unlike);
}

TEST_CASE("What has no surface is not signed, with a word", "[signature][hostile]") {
  const auto refused = [](const std::vector<float>& points, const std::vector<uint32_t>& corners) {
    const Signed result = sign(points, corners);
    return result.signature.empty() && !result.warnings.empty();
  };
  SECTION("degenerate triangles") {
    CHECK(refused(std::vector<float>(300, 1.0f), {0, 1, 2, 3, 4, 5}));
    std::vector<float> line;
    for (int i = 0; i < 300; ++i) line.insert(line.end(), {static_cast<float>(i), 0, 0});
    std::vector<uint32_t> slivers;
    for (uint32_t i = 0; i + 2 < 300; ++i) slivers.insert(slivers.end(), {i, i + 1, i + 2});
    CHECK(refused(line, slivers));
  }
  SECTION("a point cloud") {
    std::vector<float> points;
    for (int i = 0; i < 3000; ++i) points.push_back(std::sin(static_cast<float>(i * i)));
    CHECK(refused(points, {}));
  }
  SECTION("nothing") { CHECK(refused({}, {})); }
  SECTION("a single triangle") { CHECK(refused({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2})); }
  SECTION("not a number, out of range") {
    CHECK(refused({0, 0, 0, NAN, 0, 0, 0, INFINITY, 0}, {0, 1, 2, 0, 1, 9}));
  }
  SECTION("numbers whose squares are none") {
    shapes::Mesh vast = star(4, 1);
    for (float& x : vast.positions) x *= 1e38f;
    CHECK(finite(sign_mesh(vast)));
  }
}

TEST_CASE("Surfaces of any kind are signed in bounded time", "[signature][hostile]") {
  const double start = processor_seconds();
  SECTION("30,000 components are too small each") {
    shapes::Mesh dust;
    for (int i = 0; i < 30000; ++i) dust.append(tetrahedron(i % 200, i / 200));
    const Signed result = sign_mesh(dust);
    CHECK(result.signature.empty());
    CHECK_FALSE(result.warnings.empty());
  }
  SECTION("30,000 components beside a body are left out") {
    shapes::Mesh dusty = star(4, 1);
    const Signature clean = sign_mesh(dusty).signature;
    for (int i = 0; i < 30000; ++i) {
      shapes::Mesh grain = tetrahedron(i % 200, i / 200);
      for (float& x : grain.positions) x *= 1e-4f;
      dusty.append(grain);
    }
    const Signed result = sign_mesh(dusty);
    REQUIRE_FALSE(result.signature.empty());
    CHECK(shape_distance(clean, result.signature).total < 0.05);
  }
  SECTION("529 handles") {
    const shapes::Mesh plate = pierced_plate(23);
    CHECK(shapes::euler_characteristic(plate) == 2 - 2 * 529);
    const Signed result = sign_mesh(plate);
    CHECK(finite(result));
    CHECK_FALSE(result.signature.charts.empty());
  }
  SECTION("one fan of 8,000 triangles") {
    const Signed result = sign_mesh(shapes::cone(8000));
    CHECK(finite(result));
    CHECK_FALSE(result.signature.charts.empty());
  }
  SECTION("an edge of 3,000 triangles") {
    shapes::Mesh book;
    book.positions = {0, 0, 0, 0, 0, 1};
    for (uint32_t i = 0; i < 3000; ++i) {
      const double a = 2 * M_PI * i / 3000;
      for (const double x : {std::cos(a), std::sin(a), 0.5})
        book.positions.push_back(static_cast<float>(x));
      book.triangles.insert(book.triangles.end(), {0, 1, i + 2});
    }
    CHECK(finite(sign_mesh(book)));
  }
  SECTION("some numbers that are none") {
    shapes::Mesh torn = star(4, 1);
    const Signature whole = sign_mesh(torn).signature;
    torn.positions[300] = NAN;
    torn.positions[601] = -INFINITY;
    const Signed result = sign_mesh(torn);
    REQUIRE_FALSE(result.signature.empty());
    CHECK_FALSE(result.warnings.empty());
    CHECK(shape_distance(whole, result.signature).total < 0.2);
  }
  // Generous: sanitizers watch some builds, and machines differ.
  CHECK(processor_seconds() - start < 120);
}

TEST_CASE("Signatures come back from their bytes", "[signature]") {
  const Signature signature = sign_mesh(star(3, 1)).signature;
  const std::vector<uint8_t> bytes = to_bytes(signature);
  Signature back;
  REQUIRE(from_bytes(bytes, back));
  CHECK(to_bytes(back) == bytes);
  REQUIRE(back.charts.size() == signature.charts.size());
  CHECK(back.charts[0].neighbours == signature.charts[0].neighbours);
  CHECK(back.curvature.size() == size_t{kBodyValues});
  for (size_t i = 0; i < back.reach.size(); ++i)
    CHECK(back.reach[i] == Approx(signature.reach[i]).margin(0.0005));
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
