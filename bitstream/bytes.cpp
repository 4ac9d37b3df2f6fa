#include "bitstream/bytes.h"

#include <bit>

namespace reeb {
namespace {

// Bytes of a binary64 value that are left when the zero bytes at its low end are dropped.
size_t significant_bytes(uint64_t bits) {
  return bits == 0 ? 0 : 8 - static_cast<size_t>(std::countr_zero(bits)) / 8;
}

}  // namespace

void append_varuint(std::vector<uint8_t>& out, uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<uint8_t>(value | 0x80));
  out.push_back(static_cast<uint8_t>(value));
}

void append_u32(std::vector<uint8_t>& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<uint8_t>(value >> shift));
}

void append_f32(std::vector<uint8_t>& out, float value) {
  append_u32(out, std::bit_cast<uint32_t>(value));
}

void append_f64(std::vector<uint8_t>& out, double value) {
  const uint64_t bits = std::bit_cast<uint64_t>(value);
  const size_t n = significant_bytes(bits);
  out.push_back(static_cast<uint8_t>(n));
  for (size_t i = 0; i < n; ++i) out.push_back(static_cast<uint8_t>(bits >> (56 - 8 * i)));
}

void ByteReader::fail(bool ran_out) {
  if (ok_) ran_out_ = ran_out;
  ok_ = false;
}

std::span<const uint8_t> ByteReader::take(uint64_t count) {
  if (ok_ && count > remaining()) fail(true);
  if (!ok_) return {};
  const auto taken = bytes_.subspan(position_, static_cast<size_t>(count));
  position_ += taken.size();
  return taken;
}

uint8_t ByteReader::u8() {
  const auto b = take(1);
  return ok_ ? b[0] : uint8_t{0};
}

uint32_t ByteReader::u32() {
  const auto b = take(4);
  if (!ok_) return 0;
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= uint32_t{b[i]} << (8 * i);
  return value;
}

float ByteReader::f32() { return std::bit_cast<float>(u32()); }

uint64_t ByteReader::varuint() {
  uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const uint8_t b = u8();
    // The tenth byte holds the one bit that is left of 64; a zero last byte is padding.
    if (ok_ && ((shift == 63 && b > 1) || (shift > 0 && b == 0))) fail(false);
    if (!ok_) return 0;
    value |= uint64_t{b & 0x7Fu} << shift;
    if (b < 0x80) return value;
  }
  return 0;
}

double ByteReader::f64() {
  const size_t n = u8();
  if (ok_ && n > 8) fail(false);
  const auto b = take(n);
  if (!ok_) return 0;
  uint64_t bits = 0;
  for (size_t i = 0; i < n; ++i) bits |= uint64_t{b[i]} << (56 - 8 * i);
  if (significant_bytes(bits) != n) fail(false);
  return ok_ ? std::bit_cast<double>(bits) : 0.0;
}

}  // namespace reeb
