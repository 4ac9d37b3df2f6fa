#include "codec/common/sort_few.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace reeb;

TEST_CASE("items are sorted by their keys, however few", "[sort_few]") {
  for (size_t count = 0; count <= kFew; ++count) {
    std::array<int32_t, kFew> keys{};
    std::vector<uint32_t> items;
    for (size_t i = 0; i < count; ++i) {
      keys[i] = static_cast<int32_t>((i * 37 % 101) << 24 | i);
      items.push_back(static_cast<uint32_t>(i));
    }
    REQUIRE(sort_few(keys, items));
    for (size_t i = 1; i < count; ++i) CHECK(keys[items[i - 1]] < keys[items[i]]);
  }
}

TEST_CASE("items with equal keys stay as they are", "[sort_few]") {
  for (const size_t count : {2u, 8u, 9u, 16u, 24u, 25u, 32u}) {
    std::array<int32_t, kFew> keys{};
    std::vector<uint32_t> items;
    for (size_t i = 0; i < count; ++i) {
      keys[i] = static_cast<int32_t>(100 - i);
      items.push_back(static_cast<uint32_t>(7 * i));
    }
    keys[count - 1] = keys[0];
    const std::vector<uint32_t> before = items;
    CHECK(!sort_few(keys, items));
    CHECK(items == before);
  }
}
