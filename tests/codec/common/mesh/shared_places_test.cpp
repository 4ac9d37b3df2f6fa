#include "codec/common/mesh/shared_places.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

using namespace reeb;

TEST_CASE("points at one place are told from those alone", "[shared_places]") {
  CHECK(shared_places({}).empty());
  std::mt19937 random(8);
  for (const uint32_t range : {65536u, 20u, 3u, 1u}) {
    std::vector<int32_t> grid(3 * 2000);
    for (int32_t& x : grid) x = static_cast<int32_t>(random() % range);
    std::map<std::vector<int32_t>, int> count;
    for (size_t p = 0; p < 2000; ++p) ++count[{grid.begin() + 3 * p, grid.begin() + 3 * p + 3}];
    const std::vector<uint8_t> shared = shared_places(grid);
    REQUIRE(shared.size() == 2000);
    size_t taken_for_shared = 0;
    for (size_t p = 0; p < 2000; ++p) {
      const bool is_shared = count[{grid.begin() + 3 * p, grid.begin() + 3 * p + 3}] > 1;
      if (is_shared) CHECK(shared[p] == 1);
      taken_for_shared += !is_shared && shared[p] == 1 ? 1 : 0;
    }
    CHECK(taken_for_shared < 20);
  }
}

TEST_CASE("places are numbered", "[shared_places]") {
  CHECK(number_places({}).count == 0);
  std::mt19937 random(9);
  for (const uint32_t range : {65536u, 20u, 3u, 1u}) {
    std::vector<int32_t> grid(3 * 2000);
    for (int32_t& x : grid) x = static_cast<int32_t>(random() % range);
    const NumberedPlaces places = number_places(grid);
    std::map<std::vector<int32_t>, std::set<uint32_t>> numbers;
    std::set<uint32_t> all;
    for (size_t p = 0; p < 2000; ++p) {
      numbers[{grid.begin() + 3 * p, grid.begin() + 3 * p + 3}].insert(places.of_point[p]);
      if (places.of_point[p] != NumberedPlaces::kNone) all.insert(places.of_point[p]);
    }
    for (const auto& [place, found] : numbers) CHECK(found.size() == 1);
    CHECK(all.size() == places.count);
    if (places.count > 0) CHECK(*all.rbegin() == places.count - 1);
    size_t numbered = 0;
    for (const auto& [place, found] : numbers)
      numbered += *found.begin() == NumberedPlaces::kNone ? 0 : 1;
    CHECK(numbered == places.count);  // no two places have the same number
  }
}

TEST_CASE("no point of many is missed", "[shared_places]") {
  // Each place twice.
  std::vector<int32_t> grid;
  for (int32_t i = 0; i < 60000; ++i) grid.insert(grid.end(), {i % 30000, 0, 0});
  for (const uint8_t shared : shared_places(grid)) REQUIRE(shared == 1);
}
