#include "codec/common/sort_few.h"

#include <catch2/catch.hpp>

using namespace reeb;

TEST_CASE("few numbers and many are sorted alike", "[sort_few]") {
  for (const size_t count : {0u, 1u, 2u, 9u, 31u, 32u, 33u, 100u}) {
    std::vector<uint64_t> numbers;
    for (size_t i = 0; i < count; ++i) numbers.push_back((i * 37 % 101) << 40 | i);
    std::vector<uint64_t> sorted = numbers;
    sort_few(sorted);
    CHECK(std::is_sorted(sorted.begin(), sorted.end()));
    CHECK(std::is_permutation(sorted.begin(), sorted.end(), numbers.begin(), numbers.end()));
  }
}
