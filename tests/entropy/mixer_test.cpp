#include "entropy/mixer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace reeb;

namespace {

/// -log2 of the probability given to `bit`.
double cost(Probability p1, bool bit) { return -std::log2((bit ? p1 : 65536 - p1) / 65536.0); }

/// 0 .. count-1.
uint32_t pick(std::mt19937& random, uint32_t count) {
  return static_cast<uint32_t>(random() % count);
}

/// 256 ln(p / (1 - p)), p in 1/65536.
double logit(double p) {
  if (p <= 0) return -std::numeric_limits<double>::infinity();
  if (p >= 65536) return std::numeric_limits<double>::infinity();
  return 256 * std::log(p / (65536 - p));
}

}  // namespace

TEST_CASE("every entry of squash is the rounded logistic function", "[mixer]") {
  for (int x = -kSquashLimit; x <= kSquashLimit; ++x) {
    const long double exact = 65536.0L / (1.0L + std::exp(-x / 256.0L));
    const long double rounded = std::clamp(std::floor(exact + 0.5L), 1.0L, 65535.0L);
    REQUIRE(squash(x) == static_cast<Probability>(rounded));
  }
}

TEST_CASE("squash rises and is symmetric", "[mixer]") {
  for (int x = -kSquashLimit; x < kSquashLimit; ++x) {
    REQUIRE(squash(x) <= squash(x + 1));
    REQUIRE(squash(x) + squash(-x) == 65536);
  }
}

TEST_CASE("stretch lies within the log odds of its interval", "[mixer]") {
  for (int p = 1; p <= 65535; ++p) {
    const int x = stretch(static_cast<Probability>(p));
    REQUIRE(std::abs(x) <= kStretchLimit);
    const int interval = p / 16 * 16;
    const double low = std::max<double>(-kStretchLimit, logit(interval));
    const double high = std::min<double>(kStretchLimit, logit(interval + 16) + 1);
    REQUIRE(x >= std::min<double>(low, kStretchLimit));
    REQUIRE(x <= std::max<double>(high, -kStretchLimit));
  }
}

TEST_CASE("squash undoes stretch", "[mixer]") {
  for (int p = 32; p <= 65504; ++p) {
    REQUIRE(std::abs(squash(stretch(static_cast<Probability>(p))) - p) <= 8 + 65536 / (4 * 256));
  }
}

TEST_CASE("predicting does not change the mixer", "[mixer]") {
  BitMixer<2> mixer({4, 4}, 2, 250);
  const auto first = mixer.predict({1, 2}, 1);
  for (int i = 0; i < 10; ++i) mixer.predict({1, 2}, 1);
  CHECK(mixer.predict({1, 2}, 1).p1 == first.p1);
  CHECK(first.p1 == Approx(32768).margin(300));
}

TEST_CASE("mixing two sources beats the better one", "[mixer]") {
  // Each context adds its own +-2 to the log odds; a single table sees the other as noise.
  std::mt19937 random(1);
  BitMixer<2> mixer({2, 2}, 1, 250);
  AdaptiveBit alone[2][2];
  double mixed = 0, single[2] = {0, 0}, ideal = 0;
  constexpr int kCount = 60'000;
  for (int i = 0; i < kCount; ++i) {
    const uint32_t context[2] = {pick(random, 2), pick(random, 2)};
    const int odds = 512 * (static_cast<int>(context[0] + context[1]) * 2 - 2);
    const bool bit = (random() & 0xFFFF) < squash(odds);
    ideal += cost(squash(odds), bit);
    const auto made = mixer.predict({context[0], context[1]}, 0);
    mixed += cost(made.p1, bit);
    mixer.update(made, bit);
    for (int k = 0; k < 2; ++k) {
      single[k] += cost(alone[k][context[k]].p1(), bit);
      alone[k][context[k]].update(bit, 250);
    }
  }
  CHECK(mixed < 0.95 * std::min(single[0], single[1]));
  CHECK(mixed < 1.08 * ideal);
}

TEST_CASE("a useless source costs next to nothing", "[mixer]") {
  std::mt19937 random(2);
  BitMixer<2> mixer({2, 64}, 1, 250);
  AdaptiveBit alone[2];
  double mixed = 0, single = 0;
  for (int i = 0; i < 60'000; ++i) {
    const uint32_t context = pick(random, 2);
    const bool bit = random() % 20 == 0 ? context == 0 : context == 1;
    const auto made = mixer.predict({context, pick(random, 64)}, 0);
    mixed += cost(made.p1, bit);
    mixer.update(made, bit);
    single += cost(alone[context].p1(), bit);
    alone[context].update(bit, 250);
  }
  CHECK(mixed < 1.03 * single);
}

TEST_CASE("weight sets learn apart", "[mixer]") {
  // In set 0 the context tells the bit, in set 1 its opposite: one set of weights could not do it.
  std::mt19937 random(3);
  BitMixer<1> mixer({4}, 2, 250);
  double late = 0;
  for (int i = 0; i < 20'000; ++i) {
    const uint32_t set = pick(random, 2), context = pick(random, 2);
    const bool bit = (random() % 16 == 0) != (context == 1);
    const auto made = mixer.predict({set * 2 + context}, set);
    if (i >= 10'000) late += cost(made.p1, bit);
    mixer.update(made, bit);
  }
  CHECK(late / 10'000 < 0.40);  // the entropy of 1/16 is 0.337 bits
}

TEST_CASE("a mixer stays within its range on the most one-sided source", "[mixer]") {
  BitMixer<6> mixer({1, 1, 1, 1, 1, 1}, 1, 1023);
  for (int i = 0; i < 300'000; ++i) {
    const auto made = mixer.predict({0, 0, 0, 0, 0, 0}, 0);
    REQUIRE(made.p1 >= 1);
    mixer.update(made, true);
  }
  CHECK(mixer.predict({0, 0, 0, 0, 0, 0}, 0).p1 > 65'500);
  for (int i = 0; i < 5'000; ++i) {
    mixer.update(mixer.predict({0, 0, 0, 0, 0, 0}, 0), false);
  }
  CHECK(mixer.predict({0, 0, 0, 0, 0, 0}, 0).p1 < 3'000);
}
