#include "codec/common/mesh/mesh_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;
using List = std::vector<uint32_t>;

namespace {

// A strip of triangles between the points 0 1 2 3 ...: (0 1 2), (2 1 3), (2 3 4), (4 3 5), ...
List strip_triangles(uint32_t count) {
  List out;
  for (uint32_t i = 0; i < count; ++i) {
    if (i % 2 == 0) out.insert(out.end(), {i, i + 1, i + 2});
    if (i % 2 == 1) out.insert(out.end(), {i + 1, i, i + 2});
  }
  return out;
}

List known_at(const MeshWalk& walk, uint32_t turn) {
  List out;
  for (const auto& [a, b, across] : walk.triangles(turn)) out.insert(out.end(), {a, b, across});
  return out;
}

}  // namespace

TEST_CASE("the order takes every point once and grows along triangles", "[mesh_walk]") {
  const List triangles = grid_triangles(9);
  const List order = position_order(83, triangles);  // two points without triangles
  List sorted = order, all(83);
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0u);
  CHECK(sorted == all);
  CHECK(order[0] == 0);
  CHECK(order[1] == 1);
  CHECK(order[2] == 9);   // ends the first triangle
  CHECK(order[3] == 10);  // the next one, on the two before
  CHECK(position_order(0, {}).empty());
}

TEST_CASE("a walk tells the triangles known before", "[mesh_walk]") {
  const MeshWalk walk = walk_mesh(7, strip_triangles(4));
  CHECK(walk.order == List{0, 1, 2, 3, 4, 5, 6});
  CHECK(known_at(walk, 0).empty());
  CHECK(known_at(walk, 1).empty());
  CHECK(known_at(walk, 2) == List{0, 1, kNoTurn});  // the first one
  CHECK(known_at(walk, 3) == List{2, 1, 0});
  CHECK(known_at(walk, 4) == List{2, 3, 1});
  CHECK(known_at(walk, 5) == List{4, 3, 2});
  CHECK(known_at(walk, 6).empty());  // in no triangle
  CHECK(walk_mesh(0, {}).turns() == 0);
}

TEST_CASE("a walk's turns are those of its order, whatever the mesh", "[mesh_walk]") {
  for (const test::Shape& shape : test::small_shapes()) {
    INFO(shape.name);
    const List triangles = test::triangles_of(shape.connectivity);
    const uint32_t count = shape.connectivity.vertex_count;
    const MeshWalk walk = walk_mesh(count, triangles);
    REQUIRE(walk.order == position_order(count, triangles));
    // Every triangle is known at one turn, its last, unless a point has too many.
    size_t known = 0;
    for (uint32_t turn = 0; turn < count; ++turn) {
      for (const auto& [a, b, across] : walk.triangles(turn)) {
        REQUIRE(std::max(a, b) < turn);
        REQUIRE((across < turn || across == kNoTurn));
        REQUIRE(across != a);
        REQUIRE(across != b);
      }
      known += walk.triangles(turn).size();
    }
    CHECK(known <= triangles.size() / 3);
    if (shape.name != test::hub(3).name) CHECK(known == triangles.size() / 3);
  }
}
