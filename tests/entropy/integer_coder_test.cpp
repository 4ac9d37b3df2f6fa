#include "entropy/integer_coder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

template <class Model, class Value>
std::vector<Value> round_trip(const std::vector<Value>& values, size_t* bytes_used = nullptr) {
  BinaryEncoder encoder;
  Model writer;
  for (const Value v : values) CHECK(writer.code(encoder, v) == v);
  const auto bytes = encoder.finish();
  if (bytes_used != nullptr) *bytes_used = bytes.size();
  BinaryDecoder decoder(bytes);
  Model reader;
  std::vector<Value> out;
  for (size_t i = 0; i < values.size(); ++i) out.push_back(reader.code(decoder, Value{0}));
  CHECK_FALSE(decoder.overrun());
  return out;
}

}  // namespace

TEST_CASE("Exp-Golomb survives around every power of two", "[integer_coder]") {
  std::vector<uint32_t> values{0};
  for (uint32_t bits = 1; bits <= 30; ++bits) {
    for (const int offset : {-2, -1, 0, 1}) {
      values.push_back(static_cast<uint32_t>((int64_t{1} << bits) + offset));
    }
  }
  values.push_back((1u << 31) - 3);
  values.push_back((1u << 31) - 2);  // the largest
  CHECK(round_trip<ExpGolombModel>(values) == values);
  const std::vector<uint32_t> largest(50, (1u << 31) - 2);
  CHECK(round_trip<ExpGolombModel>(largest) == largest);
}

TEST_CASE("signed integers survive at both extremes", "[integer_coder]") {
  constexpr int32_t kMaxValue = 0x7FFFFFFE;
  std::vector<int32_t> values{0,          1,           -1, kMaxValue, -kMaxValue, 0,
                              0x40000000, -0x40000000, -1, 1,         0};
  CHECK(round_trip<SignedModel>(values) == values);
}

TEST_CASE("random integers of all lengths survive", "[integer_coder]") {
  std::mt19937 random(1);
  std::vector<uint32_t> plain;
  std::vector<int32_t> with_sign;
  for (int i = 0; i < 20'000; ++i) {
    plain.push_back(static_cast<uint32_t>((random() & 0x7FFFFFFE) >> random() % 31));
    with_sign.push_back(static_cast<int32_t>(plain.back()) * (random() % 2 == 0 ? 1 : -1));
  }
  CHECK(round_trip<ExpGolombModel>(plain) == plain);
  CHECK(round_trip<SignedModel>(with_sign) == with_sign);
}

TEST_CASE("geometric integers cost little more than their entropy", "[integer_coder]") {
  for (const double p : {0.5, 0.2, 0.05}) {
    std::mt19937 random(2);
    std::geometric_distribution<uint32_t> draw(p);
    std::vector<uint32_t> values;
    for (int i = 0; i < 50'000; ++i) values.push_back(draw(random));
    size_t bytes = 0;
    CHECK(round_trip<ExpGolombModel>(values, &bytes) == values);
    const double entropy = -std::log2(p) - (1 - p) / p * std::log2(1 - p);
    const double rate = static_cast<double>(bytes) * 8 / 50'000;
    CHECK(rate < 1.06 * entropy);
    CHECK(rate > 0.97 * entropy);
  }
}

TEST_CASE("a sign that never changes is nearly free", "[integer_coder]") {
  const std::vector<int32_t> values(20'000, -5);
  size_t bytes = 0;
  CHECK(round_trip<SignedModel>(values, &bytes) == values);
  CHECK(bytes < 200);
}
