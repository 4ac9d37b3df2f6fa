#include "codec/common/fields/magnitude_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

struct Item {
  Surroundings around;
  int64_t value;
};

Surroundings random_surroundings(std::mt19937& random) {
  const auto any = [&] { return static_cast<uint32_t>(random() & 0xFFFFFF) >> random() % 25; };
  Surroundings s;
  s.ring_mean = any();
  s.extra_mean = any();
  s.recent = any();
  s.history = any();
  s.last = any();
  return s;
}

std::vector<uint8_t> encode(const std::vector<Item>& items) {
  BinaryEncoder encoder;
  MagnitudeModel model;
  for (const Item& i : items) {
    MagnitudeModel::Bins bins(model, i.around);
    CHECK(model.code(encoder, bins, i.value) == i.value);
  }
  return encoder.finish();
}

void check_round_trip(const std::vector<Item>& items) {
  const auto bytes = encode(items);
  BinaryDecoder decoder(bytes);
  MagnitudeModel model;
  for (const Item& i : items) {
    MagnitudeModel::Bins bins(model, i.around);
    REQUIRE(model.code(decoder, bins, 0) == i.value);
  }
  CHECK_FALSE(decoder.overrun());
}

}  // namespace

TEST_CASE("residuals of every length survive", "[magnitude_model]") {
  std::mt19937 random(1);
  std::vector<Item> items;
  for (int64_t v = -40; v <= 40; ++v) items.push_back({random_surroundings(random), v});
  for (int bits = 5; bits < 56; ++bits) {
    const uint64_t magnitude = (uint64_t{1} << bits) + (random() & 31);
    const auto value = static_cast<int64_t>(MagnitudeModel::representable(magnitude));
    items.push_back({random_surroundings(random), value});
    items.push_back({random_surroundings(random), -value});
  }
  const auto most =
      static_cast<int64_t>(MagnitudeModel::representable(MagnitudeModel::kMaxMagnitude));
  items.push_back({random_surroundings(random), most});
  items.push_back({random_surroundings(random), -most});
  check_round_trip(items);
}

TEST_CASE("representable magnitudes are the nearest below", "[magnitude_model]") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100'000; ++i) {
    const uint64_t m = random() % (MagnitudeModel::kMaxMagnitude + 1) >> random() % 56;
    const uint64_t r = MagnitudeModel::representable(m);
    REQUIRE(r <= m);
    REQUIRE(static_cast<double>(m - r) <= static_cast<double>(m) * 0x1p-24);
    REQUIRE(MagnitudeModel::representable(r) == r);
    if (m < (1u << 24)) REQUIRE(r == m);
  }
}

TEST_CASE("random residuals survive and cost what their spread says", "[magnitude_model]") {
  for (const double spread : {0.3, 3.0, 40.0}) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, spread);
    std::vector<Item> items;
    for (int i = 0; i < 20'000; ++i) items.push_back({{}, std::lround(normal(random))});
    check_round_trip(items);
    double entropy = 0;
    for (int64_t v = -400; v <= 400; ++v) {
      const auto upper = [&](double x) { return std::erf(x / spread / std::sqrt(2.0)) / 2; };
      const double p = upper(static_cast<double>(v) + 0.5) - upper(static_cast<double>(v) - 0.5);
      if (p > 0) entropy -= p * std::log2(p);
    }
    const double rate = 8.0 * static_cast<double>(encode(items).size()) / 20'000;
    CHECK(rate > 0.98 * entropy);
    CHECK(rate < 1.10 * entropy);
  }
}

TEST_CASE("surroundings that tell the size are made use of", "[magnitude_model]") {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<Item> informed, blind;
  for (int i = 0; i < 20'000; ++i) {
    const bool large = random() % 2 == 0;
    const int64_t value = std::lround(normal(random) * (large ? 8 : 0.3));
    Surroundings s;
    s.ring_mean = s.extra_mean = s.recent = s.history = s.last = large ? 1600 : 20;
    informed.push_back({s, value});
    blind.push_back({{}, value});
  }
  CHECK(static_cast<double>(encode(informed).size()) <
        0.92 * static_cast<double>(encode(blind).size()));
}
