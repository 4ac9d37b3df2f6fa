#include "codec/common/reference/seam_finder.h"

#include <array>
#include <catch2/catch.hpp>

#include "codec/common/mesh/connectivity.h"

using namespace reeb;
using List = std::vector<uint32_t>;

namespace {

// Two squares, 0 1 2 3 and 4 5 6 7, whose sides 1-2 and 4-7 lie at the same places.
const List kSquares = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
constexpr std::array<std::array<int32_t, 3>, 8> kPlaces = {
    {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {9, 0, 0}, {18, 0, 0}, {18, 9, 0}, {9, 9, 0}}};

}  // namespace

TEST_CASE("the other side of a seam is found from a neighbour on it", "[seam_finder]") {
  const List twins = pair_half_edges(kSquares);
  const HalfEdgeFans fans(8, kSquares);
  SeamFinder seams(kSquares, twins, fans, 8);
  for (uint32_t p = 0; p < 4; ++p) seams.add(p, kPlaces[p]);
  CHECK(seams.find(4).empty());  // no neighbour is coded yet
  seams.add(4, kPlaces[4]);      // coincides with 1
  // 7 may coincide with either neighbour of 1 along the boundary; 6 is no neighbour of 4 there.
  const auto found = seams.find(7);
  CHECK(List(found.begin(), found.end()) == List{2, 0});
  CHECK(seams.find(6).empty());
}

TEST_CASE("a closed surface has no seams", "[seam_finder]") {
  const List tetrahedron = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  const List twins = pair_half_edges(tetrahedron);
  const HalfEdgeFans fans(4, tetrahedron);
  SeamFinder seams(tetrahedron, twins, fans, 4);
  for (uint32_t p = 0; p < 3; ++p) seams.add(p, kPlaces[0]);
  CHECK(seams.find(3).empty());
}
