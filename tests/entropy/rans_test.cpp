#include "entropy/rans.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

struct Item {
  uint32_t lane, cls;
  int32_t n;
};

std::vector<Item> skewed(size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Item> items;
  for (size_t i = 0; i < count; ++i) {
    const auto cls = static_cast<uint32_t>(random() % kRansClasses);
    const auto width = static_cast<uint32_t>(random() % (1 + cls));
    const auto size = static_cast<int32_t>(random() % (1u << width));
    items.push_back({static_cast<uint32_t>(i % kRansLanes), cls, random() % 2 == 0 ? size : -size});
  }
  return items;
}

std::vector<uint8_t> encode(const std::vector<Item>& items, uint32_t lanes = kRansLanes) {
  RansEncoder encoder(lanes);
  for (const Item& i : items) encoder.put(i.lane, i.cls, i.n);
  return encoder.finish();
}

void check_decodes(const std::vector<uint8_t>& bytes, const std::vector<Item>& items,
                   uint32_t lanes = kRansLanes) {
  RansDecoder decoder;
  REQUIRE(decoder.open(bytes, lanes));
  for (const Item& i : items) REQUIRE(decoder.code(i.lane, i.cls, 0) == i.n);
  CHECK(!decoder.overrun());
}

}  // namespace

TEST_CASE("buckets of rANS symbols tile the magnitudes", "[rans]") {
  uint32_t next = 0;
  for (uint32_t b = 0; b <= (kRansSymbols - 1) / 2; ++b) {
    REQUIRE(RansBuckets::begin(b) == next);
    REQUIRE(RansBuckets::of(next) == b);
    next += 1u << RansBuckets::extra_bits(b);
    REQUIRE(RansBuckets::of(next - 1) == b);
  }
  CHECK(next == kRansMaxMagnitude + 1);
  CHECK(rans_symbol(0) == 0);
  CHECK(rans_symbol(-1) == 1);
  CHECK(rans_symbol(1) == 2);
  CHECK(rans_symbol(-9) == 15);
  CHECK(rans_symbol(static_cast<int32_t>(kRansMaxMagnitude)) == kRansSymbols - 1);
}

TEST_CASE("rANS gives back what was put", "[rans]") {
  check_decodes(encode({}), {});
  for (const size_t count : {1, 15, 16, 17, 5000}) {
    const std::vector<Item> items = skewed(count, static_cast<uint32_t>(count));
    check_decodes(encode(items), items);
  }
  const std::vector<Item> items = {{0, 1, 5}, {2, 0, -3}, {1, 19, 70000}, {2, 1, 0}};
  check_decodes(encode(items, 3), items, 3);
  CHECK(encode(items, 3).size() == encode(items).size() - size_t{4} * (kRansLanes - 3));
}

TEST_CASE("rANS carries the extremes", "[rans]") {
  constexpr auto kMax = static_cast<int32_t>(kRansMaxMagnitude);
  std::vector<Item> items;
  for (const int32_t n : {0, kMax, -kMax, 8, -8, 7, -7, 1 << 29}) items.push_back({0, 19, n});
  check_decodes(encode(items), items);
  const std::vector<Item> alike(1000, Item{3, 0, -2});  // one symbol: no bits at all
  check_decodes(encode(alike), alike);
  CHECK(encode(alike).size() < 92);
}

TEST_CASE("frequencies sum to the whole and leave nothing out", "[rans]") {
  std::array<uint32_t, kRansSymbols> counts{};
  SECTION("many rare symbols beside equal ones") {
    for (uint32_t s = 0; s < kRansSymbols; ++s) counts[s] = s < 62 ? 1000000 : 1;
  }
  SECTION("one symbol") { counts[77] = 5; }
  SECTION("all alike") { counts.fill(3); }
  uint32_t sum = 0;
  const RansFrequencies frequencies = rans_frequencies(counts);
  for (uint32_t s = 0; s < kRansSymbols; ++s) {
    CHECK((frequencies[s] > 0) == (counts[s] > 0));
    sum += frequencies[s];
  }
  CHECK(sum == 1u << kRansBits);
}

TEST_CASE("coarse frequencies keep what occurs", "[rans]") {
  RansCounts counts{};
  for (uint32_t s = 0; s < 40; ++s) counts[s] = 1 + 1000 / (1 + s * s);
  SECTION("with zeros") {}
  SECTION("without") { counts[0] = 0; }
  const RansFrequencies exact = rans_frequencies(counts);
  for (uint32_t shift = 0; shift < kRansBits; ++shift) {
    RansFrequencies f = exact;
    coarsen(shift, f);
    uint32_t sum = 0;
    for (uint32_t s = 0; s < kRansSymbols; ++s) {
      sum += f[s];
      if (s == 0) continue;
      CHECK((f[s] > 0) == (counts[s] > 0));
      CHECK((f[s] == 0 || (f[s] - 1u) % (1u << shift) == 0));
    }
    CHECK((counts[0] == 0 || f[0] > 0));
    CHECK(sum == 1u << kRansBits);
  }
}

TEST_CASE("tables cost little where little was put", "[rans]") {
  // 30 integers of each class, of a spread that grows with it.
  std::mt19937 random(4);
  std::vector<Item> items;
  double bits = 0;
  for (uint32_t i = 0; i < 30 * kRansClasses; ++i) {
    const uint32_t cls = i % kRansClasses, values = 3 + 2 * cls;
    items.push_back({0, cls, static_cast<int32_t>(random() % values - cls - 1)});
    bits += std::log2(values);
  }
  CHECK(static_cast<double>(encode(items, 1).size()) < bits / 8 + 12 + 240);
  check_decodes(encode(items, 1), items, 1);
}

TEST_CASE("rANS spends what the entropy asks for", "[rans]") {
  // 0 with probability 0.9, else +-1: 0.569 bits an integer.
  std::mt19937 random(1);
  std::vector<Item> items;
  for (uint32_t i = 0; i < 80000; ++i) {
    const auto x = static_cast<uint32_t>(random() % 20);
    items.push_back({i % 8, 2, x == 0 ? 1 : x == 1 ? -1 : 0});
  }
  const double bits = 8 * static_cast<double>(encode(items).size()) / 80000;
  CHECK(bits > 0.56);
  CHECK(bits < 0.59);
}

TEST_CASE("cut rANS sections are refused or run dry", "[rans]") {
  const std::vector<Item> items = skewed(3000, 5);
  const std::vector<uint8_t> bytes = encode(items);
  for (size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 37) {
    const std::vector<uint8_t> cut(bytes.begin(),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(size));
    RansDecoder decoder;
    if (!decoder.open(cut, kRansLanes)) continue;
    for (const Item& i : items) decoder.code(i.lane, i.cls, 0);
    CHECK(decoder.overrun());
  }
}

TEST_CASE("damaged rANS sections never read out of bounds", "[rans]") {
  const std::vector<Item> items = skewed(500, 9);
  const std::vector<uint8_t> bytes = encode(items);
  std::mt19937 random(2);
  size_t opened = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<uint8_t> damaged = bytes;
    for (int i = 0; i < 3; ++i)
      damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1u << random() % 8);
    RansDecoder decoder;
    if (!decoder.open(damaged, kRansLanes)) continue;
    ++opened;
    for (const Item& i : items) {
      const int64_t n = decoder.code(i.lane, i.cls, 0);
      REQUIRE(std::abs(n) <= int64_t{kRansMaxMagnitude});
    }
  }
  CHECK(opened > 0);
}
