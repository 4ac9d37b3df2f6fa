// The yardsticks of the segmentation report.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/benchmark/comparison.h"
#include "tests/benchmark/motion_clustering.h"
#include "tests/segmentation/shapes.h"

using namespace reeb;

TEST_CASE("the Rand index counts pairs that agree") {
  const std::vector<uint32_t> a = {0, 0, 1, 1}, renamed = {7, 7, 3, 3}, b = {0, 0, 0, 1};
  CHECK(benchmark::rand_index(a, renamed) == 1);
  // Of six pairs, 01 is together in both, 03 and 13 are apart in both.
  CHECK(benchmark::rand_index(a, b) == Approx(0.5));
}

TEST_CASE("extremities match by distance along the surface") {
  const auto mesh = segmentation::shapes::open_cylinder(16, 40, 0.5, 8);
  const benchmark::ExtremityMatcher matcher(mesh.positions, mesh.triangles);
  const uint32_t far_end = 40 * 16;
  CHECK(matcher.same({0, far_end}, {1, far_end + 2}, 0.15));
  CHECK_FALSE(matcher.same({0, far_end}, {0, far_end / 2}, 0.15));
  CHECK_FALSE(matcher.same({0, far_end}, {0}, 0.15));
  CHECK_FALSE(matcher.same({0, far_end}, {0, 1}, 0.15));
}

TEST_CASE("clustering separates what moves apart") {
  const auto mesh = segmentation::shapes::square(12, 1);
  std::vector<float> frames;
  for (int t = 0; t < 5; ++t) {
    for (size_t i = 0; i < mesh.positions.size(); i += 3) {
      const float x = mesh.positions[i];
      frames.insert(frames.end(), {x, mesh.positions[i + 1],
                                   x > 0.4F ? 0.3F * static_cast<float>(t) * (x - 0.4F) : 0});
    }
  }
  const segmentation::MotionInput input = {mesh.positions, mesh.triangles, frames};
  const auto labels = benchmark::cluster_motion(input, 2, 1);
  CHECK(segmentation::motion_error(input, labels) < 1e-3);
  CHECK(segmentation::motion_error(input, std::vector<uint32_t>(labels.size(), 0)) > 1);
}
