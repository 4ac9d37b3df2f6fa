#include "codec/enc/fields/row_links.h"

#include <catch2/catch.hpp>
#include <set>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

TEST_CASE("links are the rings in both directions", "[row_links]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    const std::vector<int32_t> xyz = on_grid(shape, 12);
    const PredictionGraph g =
        build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity)).graph;
    const RowLinks links = link_rings(g);
    std::multiset<std::pair<uint32_t, uint32_t>> expected, found;
    for (uint32_t r = 0; r < g.size(); ++r) {
      for (uint32_t i = 0; i < g.rows[r].ring; ++i) {
        expected.emplace(r, g.rows[r].neighbour[i]);
        expected.emplace(g.rows[r].neighbour[i], r);
      }
      for (const uint32_t linked : links[r]) found.emplace(r, linked);
    }
    CHECK(found == expected);
  }
}
