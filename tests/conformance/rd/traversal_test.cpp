#include "conformance/rd/peers/traversal.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace reeb::conformance {
namespace {

TEST_CASE("a strip of three triangles and a vertex of none") {
  const std::vector<uint32_t> triangles = {0, 1, 2, 2, 1, 3, 2, 3, 4};
  const Traversal t = traverse(triangles, 6);
  CHECK(t.order == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(t.parallelogram_begin == std::vector<uint32_t>{0, 0, 0, 0, 1, 2, 2});
  // 3 lies across the edge 1-2 from 0, 4 across 2-3 from 1.
  std::vector<Traversal::Parallelogram> sorted = t.parallelograms;
  for (auto& p : sorted) std::sort(p.begin(), p.begin() + 2);
  CHECK(sorted == std::vector<Traversal::Parallelogram>{{1, 2, 0}, {2, 3, 1}});
  CHECK(t.neighbour_begin == std::vector<uint32_t>{0, 0, 1, 3, 5, 7, 7});
}

TEST_CASE("components follow one another, and touching in a point does not join them") {
  const std::vector<uint32_t> triangles = {4, 5, 6, 0, 1, 2, 2, 7, 8};
  const Traversal t = traverse(triangles, 9);
  CHECK(t.order == std::vector<uint32_t>{4, 5, 6, 0, 1, 2, 7, 8, 3});
  CHECK(t.parallelograms.empty());
}

TEST_CASE("a closed tetrahedron predicts its last corner from the three before it") {
  const std::vector<uint32_t> triangles = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
  const Traversal t = traverse(triangles, 4);
  CHECK(t.parallelograms.size() == 3);
  CHECK(t.neighbour_begin == std::vector<uint32_t>{0, 0, 1, 3, 6});
}

}  // namespace
}  // namespace reeb::conformance
