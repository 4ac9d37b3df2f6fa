#include "codec/common/lossless/number_set.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

using namespace reeb;

namespace {

bool same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

}  // namespace

TEST_CASE("every binary32 number has its integer, in order", "[number_set]") {
  const NumberSet set;
  constexpr float kRising[] = {
      std::numeric_limits<float>::lowest(), -1.0f, -1e-40f, -0.0f, 0.0f, 1e-45f, 1e-38f, 1.0f,
      std::numeric_limits<float>::max()};
  int64_t last = std::numeric_limits<int64_t>::min();
  for (const float x : kRising) {
    bool found = false;
    const int64_t n = set.find(x, found);
    CHECK(found);
    CHECK(n > last);
    CHECK(same_bits(set.number(n), x));
    last = n;
  }
  CHECK(set.nearest(0.0) == 0);
  CHECK(set.nearest(-0.0) == -1);
  CHECK(set.nearest(1e300) == 0x7F7FFFFF);
  CHECK(set.nearest(-1e300) == -1 - int64_t{0x7F7FFFFF});
  CHECK(set.valid(0x7F7FFFFF));
  CHECK_FALSE(set.valid(0x7F800000));  // infinity
  CHECK_FALSE(set.valid(-1 - int64_t{0x7F800000}));
  CHECK(set.spacing(set.nearest(2.0)) - set.spacing(set.nearest(1.0)) == 8);  // one octave
}

TEST_CASE("decimals of any shape are found", "[number_set]") {
  std::mt19937 random(3);
  for (uint32_t digits = 1; digits <= NumberSet::kMaxDigits; ++digits) {
    for (const uint32_t decimals : {0u, 3u, 6u, 12u, 22u}) {
      const NumberSet set(digits, decimals);
      INFO(digits << " digits, " << decimals << " decimals");
      for (int i = 0; i < 50; ++i) {
        // count * 10^-places, read as text: no more digits and places than the set has.
        uint64_t end = 1;
        for (uint32_t j = 0; j < digits; ++j) end *= 10;
        const uint64_t count = random() % end;
        const uint32_t places = decimals - std::min<uint32_t>(random() % 8, decimals);
        const std::string text = std::to_string(count) + "e-" + std::to_string(places);
        const float x = std::strtof(text.c_str(), nullptr);
        bool found = false;
        const int64_t n = set.find(x, found);
        CHECK(found);
        CHECK(same_bits(set.number(n), x));
        set.find(-x, found);
        CHECK(found);
      }
    }
  }
}

TEST_CASE("decimals are numbered without gaps", "[number_set]") {
  const NumberSet set(2, 1);  // 0, 0.1, ..., 9.9, 10, 11, ..., 99, 100, 110, ...
  CHECK(set.number(0) == 0.0f);
  CHECK(set.number(7) == 0.7f);
  CHECK(set.number(99) == 9.9f);
  CHECK(set.number(100) == 10.0f);
  CHECK(set.number(101) == 11.0f);
  CHECK(set.number(189) == 99.0f);
  CHECK(set.number(190) == 100.0f);
  CHECK(set.number(191) == 110.0f);
  CHECK(same_bits(set.number(-1), -0.0f));
  CHECK(set.number(-8) == -0.7f);
  for (int64_t n = -400; n < 400; ++n) {
    CHECK(set.nearest(static_cast<double>(set.number(n))) == n);
    CHECK(set.number(n) <= set.number(n + 1));
  }
  bool found = true;
  set.find(0.25f, found);
  CHECK_FALSE(found);
  set.find(10.5f, found);
  CHECK_FALSE(found);
  CHECK(set.nearest(9.96) == 100);
  CHECK(set.nearest(0.26) == 3);
  CHECK(set.valid(set.nearest(1e30)));
}

TEST_CASE("multiples of a step are numbered by how many steps they are", "[number_set]") {
  const NumberSet set = NumberSet::multiples(0.25);
  for (const auto& [x, n] : {std::pair(0.0, 0),
                             {0.12, 0},
                             {0.125, 1},
                             {-0.125, 0},
                             {-0.2, -1},
                             {7.0, 28},
                             {-7.1, -28}}) {
    CHECK(set.nearest(x) == n);
    CHECK(set.number(n) == 0.25f * static_cast<float>(n));
  }
  bool found = true;
  set.find(0.3f, found);
  CHECK_FALSE(found);
  set.find(-0.0f, found);
  CHECK_FALSE(found);
  CHECK(set.find(-1.75f, found) == -7);
  CHECK(found);
  CHECK(set.valid(set.nearest(1e300)));
  CHECK_FALSE(set.valid(int64_t{1} << 39));
  CHECK_FALSE(NumberSet::multiples(3e38).valid(2));  // beyond binary32
  CHECK(set.spacing(1) == set.spacing(1000));
}
