#include "codec/common/lossless/rank_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"

using namespace reeb;

namespace {

/// Contexts of differences whose size is known to be about `n`.
DifferenceContext around(int64_t n) {
  DifferenceContext c;
  c.expected = c.before = c.older = c.ring = c.nearest = c.axis_before = log_size(n);
  return c;
}

struct Item {
  int64_t n = 0;
  bool escape = false;
};

/// Differences of every length, each beside its sign.
std::vector<Item> all_lengths() {
  std::vector<Item> out{{0, false}, {0, true}};
  for (uint32_t length = 1; length <= 41; ++length) {
    const int64_t least = int64_t{1} << (length - 1);
    for (const int64_t n : {least, 2 * least - 1, least + least / 3}) {
      out.push_back({n, false});
      out.push_back({-n, false});
    }
  }
  return out;
}

template <class Model>
void check_round_trip(const std::vector<Item>& items, int64_t expected) {
  BinaryEncoder bits;
  RawBitWriter raw;
  Model encoder, decoder;
  for (const Item& item : items) {
    int64_t n = item.n;
    CHECK(encoder.code(bits, raw, around(expected), item.escape, n) != item.escape);
  }
  const std::vector<uint8_t> code = bits.finish(), rest = raw.finish();
  BinaryDecoder in(code);
  RawBitReader raw_in(rest);
  for (const Item& item : items) {
    int64_t n = 77;
    REQUIRE(decoder.code(in, raw_in, around(expected), false, n) != item.escape);
    if (!item.escape) REQUIRE(n == item.n);
  }
  CHECK_FALSE(in.overrun());
  CHECK(raw_in.at_end());
}

}  // namespace

TEST_CASE("sizes are logarithms in eighths", "[rank_model]") {
  CHECK(log_size(0) == 0);
  CHECK(log_size(1) == 8);
  CHECK(log_size(-7) == 24);
  for (const int64_t n : {3, 100, 12345, -99999, 1 << 30}) {
    const double exact = 8 * std::log2(1.0 + std::abs(static_cast<double>(n)));
    CHECK(log_size(n) <= exact);
    CHECK(log_size(n) > exact - 1.7);  // truncated twice, and linear between powers of two
  }
}

TEST_CASE("a length is found from every expectation, by steps up or down", "[rank_model]") {
  for (int32_t expected = 0; expected < 400; expected += 3) {
    for (uint32_t wanted = 0; wanted <= length_walk::kEscape; ++wanted) {
      std::vector<uint32_t> asked, steps;
      const uint32_t found = length_walk::code(expected, [&](uint32_t length, uint32_t step) {
        asked.push_back(length);
        steps.push_back(step);
        return wanted >= length;
      });
      REQUIRE(found == wanted);
      const int32_t first = std::min(std::max((expected + 4) / 8, 1), 41);
      REQUIRE(asked.front() == static_cast<uint32_t>(first));
      for (size_t i = 1; i < asked.size(); ++i) {
        const bool up = wanted >= static_cast<uint32_t>(first);
        REQUIRE(asked[i] == asked[i - 1] + (up ? 1u : ~0u));
      }
      for (size_t i = 0; i < steps.size(); ++i) {
        const int32_t step = wanted >= static_cast<uint32_t>(first)
                                 ? std::min(8 + static_cast<int32_t>(i), 16)
                                 : std::max(8 - static_cast<int32_t>(i), 0);
        REQUIRE(steps[i] == static_cast<uint32_t>(step));
      }
    }
  }
}

TEST_CASE("differences of every length come back, and so does what is none", "[rank_model]") {
  for (const int64_t expected : {int64_t{0}, int64_t{1000}, int64_t{1} << 40}) {
    check_round_trip<RankModel>(all_lengths(), expected);
    check_round_trip<QuickRankModel>(all_lengths(), expected);
  }
}

TEST_CASE("the quick method leaves as many raw bits as a difference has, its sign first",
          "[rank_model]") {
  BinaryEncoder bits;
  RawBitWriter raw;
  QuickRankModel model;
  for (int64_t n : {5, -5, 1, -1, 0}) model.code(bits, raw, around(n), false, n);
  // |5| is 101: its length is 3, its leading one is known, and the sign stands there.
  const std::vector<uint8_t> rest = raw.finish();
  RawBitReader in(rest);
  CHECK(in.code(0, 3) == 0b001);
  CHECK(in.code(0, 3) == 0b101);
  CHECK(in.code(0, 1) == 0);
  CHECK(in.code(0, 1) == 1);
  CHECK(in.at_end());
}

TEST_CASE("what is always alike costs next to nothing", "[rank_model]") {
  BinaryEncoder bits;
  RawBitWriter raw;
  RankModel model;
  for (int i = 0; i < 5000; ++i) {
    int64_t n = 6;
    model.code(bits, raw, around(6), false, n);
  }
  CHECK(raw.finish().empty());  // two places below the leading one, both modelled
  CHECK(bits.finish().size() < 5000 / 20);
}

TEST_CASE("raw bits take at most 24 at a time", "[rank_model]") {
  RawBitWriter raw;
  const uint64_t size = 0x1F3'5A5A'1234;  // 41 bits
  CHECK(code_raw(raw, size, 41) == size);
  const std::vector<uint8_t> bytes = raw.finish();
  RawBitReader in(bytes);
  CHECK(in.code(0, 24) == size >> 17);
  CHECK(in.code(0, 17) == (size & 0x1FFFF));
}
