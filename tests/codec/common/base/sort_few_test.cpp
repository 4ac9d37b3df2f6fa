#include "codec/common/base/sort_few.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace reeb;

namespace {

struct Few {
  std::vector<int32_t> keys;
  std::vector<uint32_t> items;
};

Few make(size_t count, auto key) {
  Few few = {std::vector<int32_t>(by_eights(count), kNoKey),
             std::vector<uint32_t>(by_eights(count), 9999)};
  for (size_t i = 0; i < count; ++i) {
    few.keys[i] = key(static_cast<int32_t>(i));
    few.items[i] = static_cast<uint32_t>(i);
  }
  return few;
}

}  // namespace

TEST_CASE("items are sorted by their keys, however few", "[sort_few]") {
  for (size_t count = 1; count <= kFew; ++count) {
    Few few = make(count, [](int32_t i) { return (i * 37 % 101) << 24 | i; });
    REQUIRE(sort_few(few.keys.data(), few.items.data(), count));
    for (size_t i = 1; i < count; ++i) CHECK(few.keys[few.items[i - 1]] < few.keys[few.items[i]]);
    for (size_t i = count; i < few.items.size(); ++i) CHECK(few.items[i] == 9999);
  }
}

TEST_CASE("items with equal keys stay as they are", "[sort_few]") {
  for (size_t count = 2; count <= kFew; ++count) {
    for (const int32_t equal : {1, static_cast<int32_t>(count) - 1}) {
      Few few = make(count, [=](int32_t i) { return i == equal ? 100 : 100 - i; });
      const std::vector<uint32_t> before = few.items;
      CHECK(!sort_few(few.keys.data(), few.items.data(), count));
      CHECK(few.items == before);
    }
  }
}
