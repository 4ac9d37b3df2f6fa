#include "codec/common/fast/contraction.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

SurfaceGraph contract(const Shape& shape) {
  return contract_mesh(shape.connectivity.vertex_count, triangles_of(shape.connectivity));
}

}  // namespace

TEST_CASE("contraction orders every vertex, predicted from earlier ones", "[contraction]") {
  std::vector<Shape> shapes = small_shapes();
  shapes.push_back(torus(50, 30));
  shapes.push_back(hub(300));
  for (const Shape& shape : shapes) {
    INFO(shape.name);
    const SurfaceGraph surface = contract(shape);
    std::vector<uint32_t> sorted = surface.order, all(shape.connectivity.vertex_count);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0u);
    REQUIRE(sorted == all);
    for (uint32_t r = 0; r < all.size(); ++r) {
      const PredictionGraph::Row& row = surface.graph.rows[r];
      REQUIRE((r == 0) == (row.ring == 0));
      REQUIRE(row.ring <= row.count);
      const std::set<uint32_t> distinct(&row.neighbour[0], &row.neighbour[row.count]);
      REQUIRE(distinct.size() == row.count);
      if (row.count > 0) REQUIRE(*distinct.rbegin() < r);
      for (uint32_t i = row.count; i < kMaxNeighbours; ++i) REQUIRE(row.neighbour[i] == r);
    }
  }
}

TEST_CASE("contraction leaves a small base of a closed surface", "[contraction]") {
  const SurfaceGraph surface = contract(torus(40, 40));
  // Rows of the base go by the rows before them; those after it have rings on the surface.
  uint32_t base = 0;
  while (base < surface.graph.size() && surface.graph.rows[base].ring <= 1) ++base;
  CHECK(base <= 64);
  for (uint32_t r = base; r < surface.graph.size(); ++r) REQUIRE(surface.graph.rows[r].ring >= 3);
}

TEST_CASE("a vertex knows its ring and what is beyond, the nearest first", "[contraction]") {
  // Vertex 0 of an open strip has the two neighbours 2 and 1, in the order of its one triangle.
  const SurfaceGraph surface = contract(strip(98));  // 100 vertices
  REQUIRE(surface.graph.size() == 100);
  const auto last = surface.order.back();  // removed first
  CHECK(last == 0);
  const PredictionGraph::Row& row = surface.graph.rows.back();
  REQUIRE(row.ring == 2);
  CHECK(surface.order[row.neighbour[0]] == 2);
  CHECK(surface.order[row.neighbour[1]] == 1);
  // Beyond: 3 is met twice (from 2 and 1), 4 once.
  REQUIRE(row.count == 4);
  CHECK(surface.order[row.neighbour[2]] == 3);
  CHECK(surface.order[row.neighbour[3]] == 4);
}
