#include "bitstream/utf8.h"

#include <catch2/catch.hpp>
#include <string>

#include "tests/bitstream/test_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Decodes code points by the bit layout and checks what the standard forbids: written apart from
/// the table of byte ranges.
bool decodes(const std::string& text) {
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<uint8_t>(text[i]);
    const int more = lead < 0x80       ? 0
                     : lead >> 5 == 6  ? 1
                     : lead >> 4 == 14 ? 2
                     : lead >> 3 == 30 ? 3
                                       : -1;
    if (more < 0 || i + static_cast<size_t>(more) >= text.size()) return false;
    uint32_t code = more == 0 ? lead : lead & (0x3Fu >> more);
    for (int k = 1; k <= more; ++k) {
      const auto byte = static_cast<uint8_t>(text[i + static_cast<size_t>(k)]);
      if (byte >> 6 != 2) return false;
      code = code << 6 | (byte & 0x3Fu);
    }
    const uint32_t least[] = {0, 0x80, 0x800, 0x10000};
    if (code < least[more] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return false;
    i += static_cast<size_t>(more) + 1;
  }
  return true;
}

}  // namespace

TEST_CASE("text is UTF-8 exactly where its code points decode", "[utf8]") {
  int good = 0;
  for (uint32_t first = 0; first < 256; ++first) {
    for (uint32_t second = 0; second < 256; ++second) {
      for (const char* rest : {"", "\x80", "\xBF\x80", "\x80\xBF", "\xC0", "a"}) {
        const std::string text =
            std::string{static_cast<char>(first), static_cast<char>(second)} + rest;
        const bool expected = decodes(text);
        if (is_utf8(text) != expected) FAIL("bytes " << first << " " << second);
        good += expected;
      }
    }
  }
  CHECK(good > 30'000);
  CHECK(is_utf8(""));
  CHECK(is_utf8("\xCE\xA9mega \xE6\x97\xA5\xE6\x9C\xAC \xF0\x9F\xA6\x8E"));
  CHECK_FALSE(is_utf8("caf\xE9"));
}

TEST_CASE("metadata that are not UTF-8 are neither written nor read", "[utf8]") {
  Bytes out;
  CHECK(write_header(Metadata{{{"name", "\xFF"}}}, "meta", out).code() ==
        StatusCode::kInvalidArgument);
  const Bytes payload = {1, 1, 'k', 2, 0xC0, 0x80};
  ByteReader in(payload);
  Metadata metadata;
  const Status status = read_header(in, "meta", metadata);
  CHECK(status.code() == StatusCode::kCorrupt);
  CHECK(status.message() == "meta: value is not UTF-8");
}
