#include "bitstream/crc32c.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <string_view>
#include <vector>

namespace {

// Bit by bit, straight from the polynomial.
uint32_t slow_crc(std::span<const uint8_t> bytes) {
  uint32_t crc = 0xFFFFFFFF;
  for (const uint8_t b : bytes) {
    for (int i = 0; i < 8; ++i) {
      const bool high = ((crc ^ (b >> i)) & 1) != 0;
      crc = (crc >> 1) ^ (high ? 0x82F63B78u : 0u);
    }
  }
  return ~crc;
}

std::vector<uint8_t> ascending(size_t n) {
  std::vector<uint8_t> bytes(n);
  std::iota(bytes.begin(), bytes.end(), uint8_t{7});
  return bytes;
}

}  // namespace

TEST_CASE("CRC-32C of published vectors", "[crc32c]") {
  const std::string_view digits = "123456789";
  const std::vector<uint8_t> text(digits.begin(), digits.end());
  CHECK(reeb::crc32c(text) == 0xE3069283u);  // check value of the CRC catalogue
  CHECK(reeb::crc32c(std::vector<uint8_t>(32, 0x00)) == 0x8A9136AAu);  // RFC 3720, B.4
  CHECK(reeb::crc32c(std::vector<uint8_t>(32, 0xFF)) == 0x62A8AB43u);  // RFC 3720, B.4
  CHECK(reeb::crc32c({}) == 0u);
}

TEST_CASE("CRC-32C agrees with the definition at every length", "[crc32c]") {
  for (size_t n = 0; n < 40; ++n) CHECK(reeb::crc32c(ascending(n)) == slow_crc(ascending(n)));
}

TEST_CASE("CRC-32C goes on where it stopped", "[crc32c]") {
  const auto bytes = ascending(37);
  const std::span<const uint8_t> all(bytes);
  for (size_t cut = 0; cut <= all.size(); ++cut) {
    CHECK(reeb::crc32c(all.subspan(cut), reeb::crc32c(all.first(cut))) == reeb::crc32c(all));
  }
}
