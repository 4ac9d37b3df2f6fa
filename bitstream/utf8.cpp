#include "bitstream/utf8.h"

#include <cstdint>

namespace reeb {
namespace {

/// Bytes that follow `lead`, and the range of the first of them; -1 where nothing starts so.
struct Tail {
  int count = -1;
  uint8_t lowest = 0x80, highest = 0xBF;
};

Tail tail_of(uint8_t lead) {
  if (lead < 0x80) return {0};
  if (lead >= 0xC2 && lead <= 0xDF) return {1};
  if (lead == 0xE0) return {2, 0xA0, 0xBF};
  if (lead == 0xED) return {2, 0x80, 0x9F};
  if (lead >= 0xE1 && lead <= 0xEF) return {2};
  if (lead == 0xF0) return {3, 0x90, 0xBF};
  if (lead >= 0xF1 && lead <= 0xF3) return {3};
  if (lead == 0xF4) return {3, 0x80, 0x8F};
  return {};
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size(); ++i) {
    Tail tail = tail_of(static_cast<uint8_t>(text[i]));
    if (tail.count < 0 || text.size() - i <= static_cast<size_t>(tail.count)) return false;
    for (; tail.count > 0; --tail.count) {
      const auto byte = static_cast<uint8_t>(text[++i]);
      if (byte < tail.lowest || byte > tail.highest) return false;
      tail.lowest = 0x80;
      tail.highest = 0xBF;
    }
  }
  return true;
}

}  // namespace reeb
