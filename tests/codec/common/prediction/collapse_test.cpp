#include "codec/common/prediction/collapse.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

constexpr uint32_t kMaxExtra = 10;

struct Case {
  Shape shape;
  std::vector<int32_t> grid;
  std::vector<uint32_t> triangles;
  CollapseSequence out;

  explicit Case(Shape s, uint32_t bits = 12)
      : shape(std::move(s)),
        grid(on_grid(shape, bits)),
        triangles(triangles_of(shape.connectivity)),
        out(collapse_mesh(GridPoints(grid), triangles, kMaxExtra)) {}

  uint32_t vertices() const { return shape.connectivity.vertex_count; }
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (Shape& s : small_shapes()) out.emplace_back(std::move(s));
  out.emplace_back(torus(60, 40));
  out.emplace_back(grid(40, 30));
  out.emplace_back(hub(300));          // above the largest valence that takes part
  out.emplace_back(fins(100));         // one edge of a hundred triangles
  out.emplace_back(torus(40, 30), 1);  // nearly all vertices at the same places
  out.emplace_back(strip(500));
  return out;
}

std::set<uint32_t> neighbours_of(uint32_t v, const std::vector<uint32_t>& triangles) {
  std::set<uint32_t> out;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const uint32_t* c = &triangles[t];
    if (std::find(c, c + 3, v) != c + 3) out.insert(c, c + 3);
  }
  out.erase(v);
  return out;
}

}  // namespace

TEST_CASE("every vertex is removed, kept or isolated, exactly once", "[collapse]") {
  for (const Case& c : cases()) {
    INFO(c.shape.name);
    std::vector<uint32_t> times(c.vertices(), 0);
    for (const Collapse& x : c.out.collapses) ++times.at(x.vertex);
    for (const uint32_t v : c.out.base) ++times.at(v);
    for (const uint32_t v : c.out.isolated) ++times.at(v);
    CHECK(std::all_of(times.begin(), times.end(), [](uint32_t n) { return n == 1; }));
    CHECK(std::is_sorted(c.out.base.begin(), c.out.base.end()));
    CHECK(std::is_sorted(c.out.isolated.begin(), c.out.isolated.end()));
  }
}

TEST_CASE("what surrounds a removed vertex is still there", "[collapse]") {
  for (const Case& c : cases()) {
    INFO(c.shape.name);
    std::vector<bool> gone(c.vertices(), false);
    for (const uint32_t v : c.out.isolated) gone[v] = true;
    for (const Collapse& x : c.out.collapses) {
      gone[x.vertex] = true;
      std::set<uint32_t> around(x.ring.begin(), x.ring.end());
      around.insert(x.extra.begin(), x.extra.end());
      REQUIRE(around.size() == x.ring.size() + x.extra.size());  // none twice
      REQUIRE(std::none_of(around.begin(), around.end(), [&](uint32_t u) { return gone[u]; }));
      REQUIRE_FALSE(x.ring.empty());
      REQUIRE(std::is_sorted(x.ring.begin(), x.ring.end()));
      REQUIRE(x.extra.size() <= kMaxExtra);
    }
  }
}

TEST_CASE("a vertex removed before its neighbours changed has its ring of the mesh", "[collapse]") {
  for (const Case& c : cases()) {
    INFO(c.shape.name);
    std::vector<bool> changed(c.vertices(), false);
    for (const Collapse& x : c.out.collapses) {
      if (!changed[x.vertex]) {
        const std::set<uint32_t> expected = neighbours_of(x.vertex, c.triangles);
        REQUIRE(std::set<uint32_t>(x.ring.begin(), x.ring.end()) == expected);
      }
      for (const uint32_t u : x.ring) changed[u] = true;
    }
  }
}

TEST_CASE("vertices without a triangle are isolated", "[collapse]") {
  const Case c(with_isolated(torus(8, 6), 5));
  CHECK(c.out.isolated == std::vector<uint32_t>{0, 1, 2, 3, 4, 53});
  CHECK(Case(points_only(30)).out.isolated.size() == 30);
  CHECK(Case(torus(8, 6)).out.isolated.empty());
}

TEST_CASE("a regular mesh collapses nearly to the end", "[collapse]") {
  for (const Case& c : {Case(torus(60, 40)), Case(grid(40, 30))}) {
    CHECK(c.out.base.size() < c.vertices() / 8);
    CHECK_FALSE(c.out.base.empty());
  }
}

TEST_CASE("nothing to collapse gives nothing", "[collapse]") {
  const CollapseSequence none = collapse_mesh(GridPoints({}), {}, kMaxExtra);
  CHECK(none.collapses.empty());
  CHECK(none.base.empty());
  CHECK(none.isolated.empty());
}

TEST_CASE("collapses end when every vertex could have been tried 32 times", "[collapse]") {
  // A strip with every triangle twice loses its two ends in each sweep, and nothing else. Sweeps of
  // V, V - 2, V - 4 .. vertices are tried while their sum is at most 32 V.
  for (const uint32_t vertices : {300u, 390u}) {
    uint32_t sweeps = 0;
    for (uint32_t sum = 0; sum + vertices - 2 * sweeps <= 32 * vertices; ++sweeps)
      sum += vertices - 2 * sweeps;
    REQUIRE(vertices - 2 * sweeps > 64);
    CHECK(Case(doubled_strip(vertices)).out.collapses.size() == 2 * sweeps);
  }
}
