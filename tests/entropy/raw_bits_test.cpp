#include "entropy/raw_bits.h"

#include <catch2/catch.hpp>
#include <random>
#include <utility>
#include <vector>

using namespace reeb;

TEST_CASE("raw bits are packed from the lowest bit on", "[raw_bits]") {
  RawBitWriter writer;
  writer.code(0b101, 3);
  writer.code(0, 0);
  writer.code(0b11, 2);
  writer.code(0xABCDE, 20);
  // 0xABCDE << 5 | 0b11101, least significant byte first.
  CHECK(writer.finish() == std::vector<uint8_t>{0xDD, 0x9B, 0x57, 0x01});
}

TEST_CASE("raw bits survive at every width", "[raw_bits]") {
  std::mt19937 random(5);
  std::vector<std::pair<uint32_t, uint32_t>> values;
  for (uint32_t i = 0; i < 2000; ++i) {
    const uint32_t count = i % 33;
    values.emplace_back(count == 0 ? 0 : random() >> (32 - count), count);
  }
  RawBitWriter writer;
  for (const auto& [value, count] : values) CHECK(writer.code(value, count) == value);
  const std::vector<uint8_t> bytes = writer.finish();
  RawBitReader reader(bytes);
  for (const auto& [value, count] : values) CHECK(reader.code(0, count) == value);
  CHECK_FALSE(reader.overrun());
  CHECK(reader.at_end());
  reader.code(0, 8);
  CHECK(reader.overrun());
}

TEST_CASE("raw bits past the end are zeros", "[raw_bits]") {
  RawBitReader nothing({});
  CHECK(nothing.at_end());
  CHECK(nothing.code(0, 32) == 0);
  CHECK(nothing.overrun());
  const uint8_t byte[] = {0xFF};
  RawBitReader reader(byte);
  CHECK(reader.code(0, 5) == 31);
  CHECK_FALSE(reader.at_end());  // the bits left are not 0
  CHECK(reader.code(0, 7) == 7);
  CHECK(reader.overrun());
}
