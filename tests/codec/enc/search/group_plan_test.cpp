#include "codec/enc/search/group_plan.h"

#include <catch2/catch.hpp>

using namespace reeb;

namespace {

Shot shot_of(uint32_t vertices, uint32_t frames) {
  Shot shot;
  shot.connectivity.vertex_count = vertices;
  shot.frame_count = frames;
  return shot;
}

}  // namespace

TEST_CASE("groups are as asked for", "[group_plan]") {
  EncodeOptions options;
  options.group_length = 30;
  GroupPlan plan = plan_groups(shot_of(100, 70), options);
  CHECK(plan.lengths == std::vector<uint32_t>{30, 30, 10});
  CHECK(plan.open_groups == 0);
  options.open_groups = 5;
  CHECK(plan_groups(shot_of(100, 70), options).open_groups == 5);
}

TEST_CASE("groups that nobody asks for are soon there and soon decoded", "[group_plan]") {
  EncodeOptions options;
  CHECK(plan_groups(shot_of(7000, 100), options).lengths == std::vector<uint32_t>{100});
  GroupPlan plan = plan_groups(shot_of(7000, 201), options);
  CHECK(plan.lengths == std::vector<uint32_t>{101, 100});
  CHECK(plan.open_groups == 3);
  // 8 million vertices times frames, 16 frames at least.
  CHECK(plan_groups(shot_of(100'000, 160), options).lengths == std::vector<uint32_t>{80, 80});
  CHECK(plan_groups(shot_of(1'000'000, 33), options).lengths == std::vector<uint32_t>{11, 11, 11});

  // What 5 million vertices learn would take 10 GB: groups of at most 15 components keep nothing.
  plan = plan_groups(shot_of(5'000'000, 13), options);
  CHECK(plan.lengths == std::vector<uint32_t>{5, 4, 4});
  CHECK(plan.open_groups == 0);
  options.open_groups = 2;
  plan = plan_groups(shot_of(5'000'000, 32), options);
  CHECK(plan.lengths == std::vector<uint32_t>{16, 16});
  CHECK(plan.open_groups == 2);
  options.open_groups = -1;

  // Closed ones, which cost more, are longer.
  options.profile = Profile::kFast;
  plan = plan_groups(shot_of(7000, 300), options);
  CHECK(plan.lengths == std::vector<uint32_t>{150, 150});
  CHECK(plan.open_groups == 0);
  options.profile = Profile::kMain;
  options.open_groups = 0;
  CHECK(plan_groups(shot_of(7000, 256), options).lengths == std::vector<uint32_t>{256});
}
