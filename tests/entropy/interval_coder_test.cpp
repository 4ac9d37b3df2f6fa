#include "entropy/interval_coder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

constexpr uint64_t kMaxWhole = (uint64_t{1} << 56) - 1;

using Intervals = std::vector<Interval>;

std::vector<uint8_t> encode(const Intervals& intervals) {
  IntervalEncoder encoder;
  for (const Interval& i : intervals) encoder.code(i);
  return encoder.finish();
}

/// True where the bytes lead into every interval and no more bytes were read than there may be.
bool decodes(const std::vector<uint8_t>& bytes, const Intervals& intervals) {
  IntervalDecoder decoder(bytes);
  for (const Interval& i : intervals) {
    const uint64_t place = decoder.find(i.whole);
    if (place < i.below || place - i.below >= i.size) return false;
    decoder.code(i);
  }
  return !decoder.overrun();
}

double information(const Intervals& intervals) {
  double bits = 0;
  for (const Interval& i : intervals)
    bits += std::log2(static_cast<double>(i.whole) / static_cast<double>(i.size));
  return bits;
}

/// Drawn as often as they are probable: where a place falls between two bounds.
Intervals draw(std::mt19937_64& random, size_t count, uint64_t whole) {
  Intervals out;
  for (size_t i = 0; i < count; ++i) {
    const uint64_t bound = random() % (whole - 1) + 1;
    const bool above = random() % whole >= bound;
    out.push_back(above ? Interval{bound, whole - bound, whole} : Interval{0, bound, whole});
  }
  return out;
}

}  // namespace

TEST_CASE("no intervals take no bytes", "[interval_coder]") {
  CHECK(encode({}).empty());
  CHECK(decodes({}, {}));
  CHECK(encode(Intervals(1000, {0, 77, 77})).empty());  // what is certain
}

TEST_CASE("one interval anywhere survives", "[interval_coder]") {
  for (const uint64_t whole : {uint64_t{1}, uint64_t{2}, uint64_t{1000}, kMaxWhole}) {
    for (const uint64_t size : {uint64_t{1}, whole / 2, whole - 1, whole}) {
      for (const uint64_t below : {uint64_t{0}, (whole - size) / 2, whole - size}) {
        if (size == 0) continue;
        const Intervals one = {{below, size, whole}};
        const auto bytes = encode(one);
        CHECK(decodes(bytes, one));
        CHECK(static_cast<double>(bytes.size()) <= information(one) / 8 + 2);
      }
    }
  }
}

TEST_CASE("random intervals survive and are as long as their information", "[interval_coder]") {
  std::mt19937_64 random(1);
  for (const uint64_t whole : {uint64_t{2}, uint64_t{3}, uint64_t{65537}, uint64_t{1} << 47}) {
    for (const size_t count : {1u, 2u, 50u, 40'000u}) {
      const Intervals intervals = draw(random, count, whole);
      const auto bytes = encode(intervals);
      CHECK(decodes(bytes, intervals));
      CHECK(static_cast<double>(bytes.size()) <= 1.0005 * information(intervals) / 8 + 2);
      CHECK(static_cast<double>(bytes.size()) >= information(intervals) / 8 - 8);
    }
  }
}

TEST_CASE("intervals of any wholes, against the odds", "[interval_coder]") {
  std::mt19937_64 random(2);
  for (int round = 0; round < 300; ++round) {
    Intervals intervals;
    for (int i = 0; i < 100; ++i) {
      const uint64_t whole = (random() >> (8 + random() % 56)) + 1;
      const uint64_t below = random() % whole;
      intervals.push_back({below, random() % (whole - below) + 1, whole});
    }
    CHECK(decodes(encode(intervals), intervals));
  }
}

TEST_CASE("bits and intervals take turns", "[interval_coder]") {
  std::mt19937_64 random(3);
  std::vector<std::pair<bool, Probability>> bits;
  Intervals intervals = draw(random, 5000, 12'345);
  IntervalEncoder encoder;
  for (const Interval& i : intervals) {
    const auto p1 = static_cast<Probability>(1 + random() % 65535);
    bits.emplace_back((random() & 1) != 0, p1);
    encoder.code(i);
    CHECK(encoder.code(bits.back().first, p1) == bits.back().first);
  }
  const auto bytes = encoder.finish();
  IntervalDecoder decoder(bytes);
  for (size_t i = 0; i < bits.size(); ++i) {
    const uint64_t place = decoder.find(intervals[i].whole);
    REQUIRE((place >= intervals[i].below && place - intervals[i].below < intervals[i].size));
    decoder.code(intervals[i]);
    REQUIRE(decoder.code(false, bits[i].second) == bits[i].first);
  }
  CHECK(!decoder.overrun());
}

TEST_CASE("a carry of intervals runs through thousands of bytes", "[interval_coder]") {
  // The intervals straddle 0x2C0000... until the last one is on one side.
  constexpr uint64_t kWhole = uint64_t{1} << 40;
  const std::vector<uint8_t> number = {0x2C};
  IntervalDecoder decoder(number);
  Intervals straddling;
  for (int i = 0; i < 20'000; ++i) {
    straddling.push_back({decoder.find(3), 1, 3});
    decoder.code(straddling.back());
  }
  const uint64_t place = decoder.find(kWhole);
  REQUIRE(place > 0);
  REQUIRE(place + 1 < kWhole);
  const auto run = static_cast<size_t>(information(straddling) / 8) - 16;
  const auto check = [&](const Interval& side, uint8_t first, uint8_t others) {
    Intervals intervals = straddling;
    intervals.push_back(side);
    const auto bytes = encode(intervals);
    CHECK(decodes(bytes, intervals));
    REQUIRE(bytes.size() > run);
    CHECK(bytes[0] == first);
    CHECK(std::all_of(&bytes[1], &bytes[run], [&](uint8_t b) { return b == others; }));
  };
  check({place + 1, kWhole - place - 1, kWhole}, 0x2C, 0x00);
  check({0, place, kWhole}, 0x2B, 0xFF);
}

TEST_CASE("intervals whose bytes are all zero are not taken for cut ones", "[interval_coder]") {
  for (const size_t count : {1u, 8u, 33u, 64u, 1000u}) {
    const Intervals low(count, {0, 1, 2});  // the bottom of the range
    CHECK(decodes(encode(low), low));
    Intervals high(count, {1, 1, 2});  // its top
    CHECK(decodes(encode(high), high));
    high.insert(high.end(), low.begin(), low.end());
    CHECK(decodes(encode(high), high));
  }
}

TEST_CASE("reading intervals on past the end is noticed", "[interval_coder]") {
  std::mt19937_64 random(4);
  const Intervals intervals(8000, {0, 1, 4});
  auto bytes = encode(intervals);
  IntervalDecoder whole(bytes);
  for (const Interval& i : intervals) whole.code(i);
  CHECK_FALSE(whole.overrun());
  for (int i = 0; i < 128; ++i) whole.code(false, kEvenOdds);
  CHECK(whole.overrun());

  bytes.resize(bytes.size() / 2);
  IntervalDecoder cut(bytes);
  for (const Interval& i : intervals) cut.code(i);
  CHECK(cut.overrun());
}

TEST_CASE("any bytes decode to some intervals", "[interval_coder]") {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<uint8_t> bytes(random() % 50);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(round % 3 == 0 ? 0xFF : random());
    IntervalDecoder decoder(bytes);
    size_t steps = 0;
    for (; !decoder.overrun() && steps < 100'000; ++steps) {
      const uint64_t whole = random() % kMaxWhole + 1;
      const uint64_t place = decoder.find(whole);
      REQUIRE(place < whole);
      decoder.code({place, 1, whole});
      decoder.code(false, static_cast<Probability>(1 + random() % 65535));
    }
    CHECK(decoder.overrun());
  }
}

TEST_CASE("the bytes of the specification decode to what it says", "[interval_coder]") {
  const std::vector<uint8_t> bytes = {0x8E, 0x41, 0xB7, 0xD2, 0x05, 0xF3, 0x9A, 0x6C, 0x10, 0x7E};
  IntervalDecoder decoder(bytes);
  for (const int expected : {555, 690, 277, 838, 904, 508}) {
    const uint64_t place = decoder.find(1000);
    CHECK(place == static_cast<uint64_t>(expected));
    decoder.code({place, 1, 1000});
  }
}
