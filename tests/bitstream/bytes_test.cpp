#include "bitstream/bytes.h"

#include <bit>
#include <catch2/catch.hpp>
#include <limits>

using reeb::ByteReader;
using Bytes = std::vector<uint8_t>;

TEST_CASE("varuint has the documented bytes", "[bytes]") {
  const std::pair<uint64_t, Bytes> cases[] = {
      {0, {0}},
      {127, {0x7F}},
      {128, {0x80, 0x01}},
      {300, {0xAC, 0x02}},
      {uint64_t{1} << 63, {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x01}}};
  for (const auto& [value, expected] : cases) {
    Bytes out;
    reeb::append_varuint(out, value);
    CHECK(out == expected);
    ByteReader in(out);
    CHECK(in.varuint() == value);
    CHECK(in.ok());
    CHECK(in.remaining() == 0);
  }
}

TEST_CASE("malformed varuints are refused", "[bytes]") {
  const Bytes padded = {0x81, 0x00};
  const Bytes too_long = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x02};
  for (const Bytes& bytes : {padded, too_long}) {
    ByteReader in(bytes);
    CHECK(in.varuint() == 0);
    CHECK_FALSE(in.ok());
    CHECK_FALSE(in.ran_out());
  }
  const Bytes cut = {0x80};
  ByteReader in(cut);
  (void)in.varuint();
  CHECK(in.ran_out());
}

TEST_CASE("float64 is short for round numbers and exact for all", "[bytes]") {
  const std::pair<double, size_t> cases[] = {
      {0.0, 1}, {30.0, 3}, {-2.0, 2}, {30000.0 / 1001.0, 9}, {-0.0, 2}, {5e-324, 9}};
  for (const auto& [value, size] : cases) {
    Bytes out;
    reeb::append_f64(out, value);
    CHECK(out.size() == size);
    ByteReader in(out);
    CHECK(std::bit_cast<uint64_t>(in.f64()) == std::bit_cast<uint64_t>(value));
    CHECK(in.ok());
  }
  Bytes thirty;
  reeb::append_f64(thirty, 30.0);
  CHECK(thirty == Bytes{2, 0x40, 0x3E});
}

TEST_CASE("float64 with padding or a wrong count is refused", "[bytes]") {
  for (const Bytes& bytes : {Bytes{3, 0x40, 0x3E, 0x00}, Bytes{9, 1, 1, 1, 1, 1, 1, 1, 1, 1}}) {
    ByteReader in(bytes);
    CHECK(in.f64() == 0.0);
    CHECK_FALSE(in.ok());
    CHECK_FALSE(in.ran_out());
  }
}

TEST_CASE("fixed-size numbers are little-endian", "[bytes]") {
  Bytes out;
  reeb::append_u32(out, 0x01020304);
  reeb::append_f32(out, 1.0f);
  CHECK(out == Bytes{4, 3, 2, 1, 0, 0, 0x80, 0x3F});
  ByteReader in(out);
  CHECK(in.u32() == 0x01020304);
  CHECK(in.f32() == 1.0f);
}

TEST_CASE("the first read past the end sticks", "[bytes]") {
  const Bytes three = {1, 2, 3};
  ByteReader in(three);
  CHECK(in.u32() == 0);
  CHECK_FALSE(in.ok());
  CHECK(in.u8() == 0);  // though bytes are left
  CHECK(in.take(1).empty());
  ByteReader huge(three);
  CHECK(huge.take(std::numeric_limits<uint64_t>::max()).empty());
  CHECK(huge.ran_out());
}
