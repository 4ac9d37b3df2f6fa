#include "codec/enc/search/shot_encoder.h"

#include <catch2/catch.hpp>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

double largest_piece(const Shape& shape) { return reeb::largest_piece(shape.connectivity); }

}  // namespace

TEST_CASE("a mesh is found in one piece or in several", "[shot_encoder]") {
  CHECK(largest_piece(torus(12, 8)) == 1);
  CHECK(largest_piece(strip(9)) == 1);
  const Shape two = two_components();  // the second one is a tetrahedron
  const double count = two.connectivity.vertex_count;
  CHECK(largest_piece(two) == (count - 4) / count);
  const Shape isolated = with_isolated(tetrahedron(), 6);
  CHECK(largest_piece(isolated) == 4.0 / isolated.connectivity.vertex_count);
  CHECK(largest_piece(points_only(5)) == 1 / 5.0);
}
