#include "entropy/adaptive_bit.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

TEST_CASE("a new adaptive bit takes both values to be as likely", "[adaptive_bit]") {
  CHECK(AdaptiveBit().p1() == kEvenOdds);
  CHECK(AdaptiveBit().count() == 0);
}

TEST_CASE("an adaptive bit learns the frequency of its decisions", "[adaptive_bit]") {
  for (const double frequency : {0.02, 0.3, 0.5, 0.8, 0.99}) {
    std::mt19937 random(7);
    std::bernoulli_distribution draw(frequency);
    AdaptiveBit bit;
    double sum = 0;
    constexpr int kWarmUp = 3000, kCount = 20'000;
    for (int i = 0; i < kWarmUp + kCount; ++i) {
      if (i >= kWarmUp) sum += bit.p1() / 65536.0;
      bit.update(draw(random), 1023);
    }
    // The mean over the run has a standard deviation of sqrt(f (1-f) / 20000) < 0.004.
    CHECK(sum / kCount == Approx(frequency).margin(0.012));
  }
}

TEST_CASE("the first decisions are averaged like counts", "[adaptive_bit]") {
  // With rates 1 / (n + 1.5) the estimate after n decisions is (ones + 1/4) / (n + 1/2).
  std::mt19937 random(8);
  AdaptiveBit bit;
  int ones = 0;
  for (int n = 1; n <= 200; ++n) {
    const bool value = random() % 3 == 0;
    ones += value;
    bit.update(value, 1023);
    CHECK(bit.count() == static_cast<uint32_t>(n));
    CHECK(bit.p1() / 65536.0 == Approx((ones + 0.25) / (n + 0.5)).margin(0.002));
  }
}

TEST_CASE("an adaptive bit is never certain and always recovers", "[adaptive_bit]") {
  for (const bool value : {false, true}) {
    for (const uint32_t limit : {1u, 30u, 255u, 1023u}) {
      AdaptiveBit bit;
      for (int i = 0; i < 100'000; ++i) {
        bit.update(value, limit);
        REQUIRE(bit.p1() >= 1);
        REQUIRE(bit.p1() <= 65535);
      }
      CHECK(bit.count() == limit);
      CHECK((value ? bit.p1() > 65'000 : bit.p1() < 536));
      for (uint32_t i = 0; i < 8 * (limit + 2); ++i) bit.update(!value, limit);
      CHECK((value ? bit.p1() < 536 : bit.p1() > 65'000));
    }
  }
}

TEST_CASE("a low limit follows a change sooner", "[adaptive_bit]") {
  AdaptiveBit quick, slow;
  for (int i = 0; i < 1000; ++i) {
    quick.update(false, 15);
    slow.update(false, 1000);
  }
  for (int i = 0; i < 30; ++i) {
    quick.update(true, 15);
    slow.update(true, 1000);
  }
  CHECK(quick.p1() > 50'000);
  CHECK(slow.p1() < 6'000);
}

TEST_CASE("encoder and decoder learn the same", "[adaptive_bit]") {
  std::mt19937 random(9);
  BinaryEncoder encoder;
  AdaptiveBit there;
  std::vector<bool> bits;
  for (int i = 0; i < 5000; ++i) {
    bits.push_back(random() % 10 == 0);
    there.code(encoder, bits.back(), 100);
  }
  const auto bytes = encoder.finish();
  BinaryDecoder decoder(bytes);
  AdaptiveBit here;
  for (const bool bit : bits) REQUIRE(here.code(decoder, false, 100) == bit);
  CHECK(here.p1() == there.p1());
  // The entropy at 0.1 is 0.469 bits a decision; learning at a rate of 1/100 costs a few per cent.
  CHECK(static_cast<double>(bytes.size()) * 8 / 5000 < 0.469 * 1.1);
}

TEST_CASE("a short bit learns nearly what an adaptive bit does", "[adaptive_bit]") {
  CHECK(ShortBit().p1() == kEvenOdds);
  for (const double frequency : {0.02, 0.3, 0.5, 0.8, 0.99}) {
    std::mt19937 random(11);
    std::bernoulli_distribution draw(frequency);
    AdaptiveBit exact;
    ShortBit bit;
    for (int i = 0; i < 20'000; ++i) {
      const bool value = draw(random);
      exact.update(value, 40);
      bit.update(value, 40);
      // Steps are rounded down to 1/65536, of which the rate forgets 1 in 41.
      REQUIRE(std::abs(int{bit.p1()} - int{exact.p1()}) <= 64);
    }
  }
}

TEST_CASE("a short bit is never certain and always recovers", "[adaptive_bit]") {
  for (const bool value : {false, true}) {
    for (const uint32_t limit : {1u, 40u, 255u}) {
      ShortBit bit;
      for (int i = 0; i < 10'000; ++i) {
        bit.update(value, limit);
        REQUIRE(bit.p1() >= 32);
        REQUIRE(bit.p1() <= 65504);
      }
      CHECK((value ? bit.p1() > 65'000 : bit.p1() < 536));
      for (uint32_t i = 0; i < 8 * (limit + 2); ++i) bit.update(!value, limit);
      CHECK((value ? bit.p1() < 536 : bit.p1() > 65'000));
    }
  }
}
