#include "codec/common/prediction/neighbour_lists.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

using namespace reeb;

TEST_CASE("neighbour lists hold what sets hold, and none behind it", "[neighbour_lists]") {
  constexpr uint32_t kNone = 1000;
  const std::vector<uint32_t> capacity = {0, 7, 8, 9, 40};
  NeighbourLists lists(capacity, kNone);
  std::vector<std::set<uint32_t>> expected(capacity.size());
  std::mt19937 random(3);
  for (int step = 0; step < 4000; ++step) {
    const auto list = static_cast<uint32_t>(random() % capacity.size());
    std::set<uint32_t>& set = expected[list];
    const auto x = static_cast<uint32_t>(random() % 100);
    if (set.count(x) == 1) {
      const auto by = static_cast<uint32_t>(100 + random() % 100);
      const bool replaces = random() % 2 == 0 && set.count(by) == 0;
      set.erase(x);
      if (replaces) set.insert(by);
      lists.replace_or_erase(list, x, by, !replaces);
    } else {
      const bool pushes = random() % 4 > 0;
      if (pushes) set.insert(x);
      lists.push_back_if(pushes, list, x);
    }
    const auto items = lists[list];
    REQUIRE(std::set<uint32_t>(items.begin(), items.end()) == set);
    REQUIRE(items.size() == set.size());
    const auto eights = lists.by_eights(list);
    REQUIRE(eights.size() == (set.size() + 7) / 8 * 8);
    REQUIRE(std::count(eights.begin() + static_cast<ptrdiff_t>(set.size()), eights.end(), kNone) ==
            static_cast<ptrdiff_t>(eights.size() - set.size()));
  }
}

TEST_CASE("a filtered neighbour list keeps what it is told to", "[neighbour_lists]") {
  constexpr uint32_t kNone = 50;
  NeighbourLists lists({12}, kNone);
  for (uint32_t x = 0; x < 12; ++x) lists.push_back(0, x);
  lists.filter(0, [](uint32_t x) { return x % 3 == 1; });
  const auto eights = lists.by_eights(0);
  CHECK(std::vector<uint32_t>(eights.begin(), eights.end()) ==
        std::vector<uint32_t>{1, 4, 7, 10, kNone, kNone, kNone, kNone});
}
