#include "conformance/rd/sted.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace reeb::conformance {
namespace {

Shot triangle() {
  Shot shot;
  shot.connectivity = {3, {3}, {0, 1, 2}};
  shot.frame_count = 1;
  shot.positions = {0, 0, 0, 3, 0, 0, 0, 4, 0};
  return shot;
}

TEST_CASE("what is equal differs by nothing") {
  const Shot shot = triangle();
  CHECK(spatio_temporal_edge_difference(shot, shot.positions, 5).combined == 0);
}

TEST_CASE("moving and growing evenly does not show") {
  const Shot shot = triangle();
  std::vector<float> decoded = shot.positions;
  for (float& x : decoded) x = 2 * x + 7;
  CHECK(spatio_temporal_edge_difference(shot, decoded, 5).combined < 1e-7);
}

TEST_CASE("one moved corner of a 3-4-5 triangle") {
  const Shot shot = triangle();
  std::vector<float> decoded = shot.positions;
  decoded[3] = 4;  // edges 3, 4, 5 become 4, 4, sqrt(32): relative differences 1/3, 0, 0.13137
  const Sted sted = spatio_temporal_edge_difference(shot, decoded, 5);
  CHECK(sted.spatial ==
        Approx(0.10933686).epsilon(1e-6));  // weighted deviations worked out by hand
  CHECK(sted.temporal == 0);
  CHECK(sted.combined == sted.spatial);
}

TEST_CASE("edges count once however many faces have them, and not at all without length") {
  Shot shot = triangle();
  std::vector<float> decoded = shot.positions;
  decoded[3] = 4;
  const double once = spatio_temporal_edge_difference(shot, decoded, 5).spatial;
  shot.connectivity = {3, {3, 3, 2}, {0, 1, 2, 2, 1, 0, 1, 1}};
  CHECK(spatio_temporal_edge_difference(shot, decoded, 5).spatial == once);
  shot.positions[3] = shot.positions[6] = 0;
  shot.positions[7] = 0;
  CHECK(spatio_temporal_edge_difference(shot, decoded, 5).spatial == 0);
}

TEST_CASE("a jerk in time shows, a uniform speed does not") {
  Shot shot;
  shot.connectivity = {1, {}, {}};
  shot.frame_count = 3;
  shot.positions = std::vector<float>(9, 0.0f);
  // With the second step sqrt(3) frame distances long, its edge doubles: relative differences 0, 1.
  const auto jump = static_cast<float>(0.002 * std::sqrt(3.0) * 10);
  const Sted jerk =
      spatio_temporal_edge_difference(shot, std::vector<float>{0, 0, 0, 0, 0, 0, 0, jump, 0}, 10);
  CHECK(jerk.temporal == Approx(0.5).epsilon(1e-6));
  CHECK(jerk.combined == Approx(0.136 * 0.5).epsilon(1e-6));
  const Sted glide = spatio_temporal_edge_difference(
      shot, std::vector<float>{0, 0, 0, 0, jump, 0, 0, 2 * jump, 0}, 10);
  CHECK(glide.temporal < 1e-6);
}

}  // namespace
}  // namespace reeb::conformance
