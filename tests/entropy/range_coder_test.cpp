#include "entropy/range_coder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

struct Decision {
  bool bit;
  Probability p1;
};
using Decisions = std::vector<Decision>;

std::vector<uint8_t> encode(const Decisions& decisions) {
  BinaryEncoder encoder;
  for (const Decision& d : decisions) CHECK(encoder.code(d.bit, d.p1) == d.bit);
  return encoder.finish();
}

/// True where the bytes give the decisions back and no more bytes were read than there may be.
bool decodes(const std::vector<uint8_t>& bytes, const Decisions& decisions) {
  BinaryDecoder decoder(bytes);
  for (const Decision& d : decisions) {
    if (decoder.code(!d.bit, d.p1) != d.bit) return false;
  }
  return !decoder.overrun();
}

double information(const Decisions& decisions) {
  double bits = 0;
  for (const Decision& d : decisions) bits -= std::log2((d.bit ? d.p1 : 65536 - d.p1) / 65536.0);
  return bits;
}

/// Decisions drawn with exactly the probabilities that they are coded with.
Decisions draw(std::mt19937& random, size_t count, auto&& probability) {
  Decisions out;
  for (size_t i = 0; i < count; ++i) {
    const Probability p1 = probability();
    out.push_back({(random() & 0xFFFF) < p1, p1});
  }
  return out;
}

/// The decisions that keep the number with these first bytes (zeros follow) within the coder's
/// interval: what a decoder reads from them.
Decisions follow(const std::vector<uint8_t>& number, size_t count, Probability p1) {
  BinaryDecoder decoder(number);
  Decisions out;
  for (size_t i = 0; i < count; ++i) out.push_back({decoder.code(false, p1), p1});
  return out;
}

}  // namespace

TEST_CASE("nothing coded takes no bytes", "[range_coder]") {
  CHECK(encode({}).empty());
  CHECK(decodes({}, {}));
}

TEST_CASE("one decision of any probability survives", "[range_coder]") {
  for (const int p : {1, 2, 255, 256, 32768, 65280, 65534, 65535}) {
    const auto p1 = static_cast<Probability>(p);
    for (const bool bit : {false, true}) {
      const auto bytes = encode({{bit, p1}});
      CHECK(decodes(bytes, {{bit, p1}}));
      CHECK(bytes.size() <= 3);  // 16 bits at most, and what tells them from others
    }
  }
}

TEST_CASE("random decisions of random probabilities survive", "[range_coder]") {
  std::mt19937 random(1);
  for (size_t count = 1; count < 400; ++count) {
    const auto any = [&] { return static_cast<Probability>(1 + random() % 65535); };
    Decisions decisions = draw(random, count, any);
    if (count % 2 == 0) {
      for (Decision& d : decisions) d.bit = (random() & 1) != 0;  // against the odds
    }
    CHECK(decodes(encode(decisions), decisions));
  }
}

TEST_CASE("the code is as long as its information", "[range_coder]") {
  std::mt19937 random(2);
  for (const uint32_t p1 : {1u, 40u, 700u, 6000u, 32768u, 60000u, 65500u, 65535u}) {
    const auto constant = [p1] { return static_cast<Probability>(p1); };
    const Decisions decisions = draw(random, 400'000, constant);
    const auto bytes = encode(decisions);
    CHECK(decodes(bytes, decisions));
    CHECK(static_cast<double>(bytes.size()) <= 1.001 * information(decisions) / 8 + 4);
    CHECK(static_cast<double>(bytes.size()) >= information(decisions) / 8 - 4);
  }
}

TEST_CASE("the least probable decisions cost 16 bits each", "[range_coder]") {
  for (const bool bit : {false, true}) {
    const Decisions decisions(5000, {bit, static_cast<Probability>(bit ? 1 : 65535)});
    const auto bytes = encode(decisions);
    CHECK(decodes(bytes, decisions));
    CHECK(bytes.size() >= 9'990);
    CHECK(bytes.size() <= 10'050);  // a range of 24 bits times 2^-16 leaves 8 bits to round
  }
}

TEST_CASE("a carry runs through thousands of bytes", "[range_coder]") {
  // The interval straddles 0x2C0000... until the last decision puts it on one side.
  constexpr size_t kCount = 40'000;
  const Decisions straddling = follow({0x2C}, kCount, 21'845);
  const auto run = static_cast<size_t>(information(straddling) / 8) - 8;

  Decisions above = straddling;
  above.push_back({false, 65'535});
  const auto carried = encode(above);
  REQUIRE(carried.size() > run);
  CHECK(carried[0] == 0x2C);
  CHECK(std::all_of(&carried[1], &carried[run], [](uint8_t b) { return b == 0x00; }));
  CHECK(decodes(carried, above));

  Decisions below = straddling;
  below.push_back({true, 1});
  const auto plain = encode(below);
  REQUIRE(plain.size() > run);
  CHECK(plain[0] == 0x2B);
  CHECK(std::all_of(&plain[1], &plain[run], [](uint8_t b) { return b == 0xFF; }));
  CHECK(decodes(plain, below));
}

TEST_CASE("a code that starts with bytes of 0xFF survives", "[range_coder]") {
  for (const size_t count : {1u, 7u, 8u, 9u, 31u, 32u, 33u, 1000u}) {
    const Decisions decisions(count, {false, kEvenOdds});  // the top of the interval
    CHECK(decodes(encode(decisions), decisions));
  }
}

TEST_CASE("a code whose bytes are all zero is not taken for a cut one", "[range_coder]") {
  for (const size_t count : {1u, 8u, 33u, 64u, 1000u}) {
    const Decisions low(count, {true, kEvenOdds});  // the bottom of the interval
    CHECK(decodes(encode(low), low));
    Decisions behind = {{false, kEvenOdds}, {false, 12'345}};
    behind.insert(behind.end(), low.begin(), low.end());
    CHECK(decodes(encode(behind), behind));
  }
}

TEST_CASE("reading on past the end is noticed", "[range_coder]") {
  std::mt19937 random(3);
  const auto fair = [] { return kEvenOdds; };
  const Decisions decisions = draw(random, 8000, fair);
  auto bytes = encode(decisions);
  BinaryDecoder whole(bytes);
  for (const Decision& d : decisions) whole.code(false, d.p1);
  CHECK_FALSE(whole.overrun());
  for (int i = 0; i < 64; ++i) whole.code(false, kEvenOdds);
  CHECK(whole.overrun());

  bytes.resize(bytes.size() / 2);
  BinaryDecoder cut(bytes);
  for (const Decision& d : decisions) cut.code(false, d.p1);
  CHECK(cut.overrun());
}

TEST_CASE("any bytes decode to something", "[range_coder]") {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    std::vector<uint8_t> bytes(random() % 50);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(round % 3 == 0 ? 0xFF : random());
    BinaryDecoder decoder(bytes);
    size_t steps = 0;
    while (!decoder.overrun() && steps < 100'000) {
      decoder.code(false, static_cast<Probability>(1 + random() % 65535));
      ++steps;
    }
    CHECK(decoder.overrun());
  }
}
