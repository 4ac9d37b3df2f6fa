#include "codec/common/base/integer_math.h"

#include <catch2/catch.hpp>
#include <random>

using namespace reeb;

TEST_CASE("isqrt is the floor of the square root", "[integer_math]") {
  constexpr uint64_t kEnd = uint64_t{1} << 52;
  const auto check = [](uint64_t n) {
    const uint64_t root = isqrt(n);
    REQUIRE(root * root <= n);
    REQUIRE((root + 1) * (root + 1) > n);
  };
  for (uint64_t n = 0; n < 5000; ++n) check(n);
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    check(random() % kEnd >> random() % 52);
    const uint64_t root = 1 + random() % ((uint64_t{1} << 26) - 1);
    check(root * root);
    check(root * root - 1);
  }
  check(kEnd - 1);
}

TEST_CASE("log2_q5 is exact at powers of two and linear between them", "[integer_math]") {
  for (uint32_t k = 0; k < 64; ++k) CHECK(log2_q5(uint64_t{1} << k) == 32 * k);
  for (uint32_t k = 5; k < 59; ++k) {
    for (uint64_t i = 0; i < 32; ++i) {
      const uint64_t step = uint64_t{1} << (k - 5);
      CHECK(log2_q5((uint64_t{1} << k) + i * step) == 32 * k + i);
      CHECK(log2_q5((uint64_t{1} << k) + (i + 1) * step - 1) == 32 * k + i);
    }
  }
  CHECK(log2_q5(3) == 32 + 16);
  CHECK(log2_q5(UINT64_MAX) == 63 * 32 + 31);
}

TEST_CASE("log2_q5 never falls", "[integer_math]") {
  for (uint64_t x = 1; x < 100'000; ++x) REQUIRE(log2_q5(x) <= log2_q5(x + 1));
}
