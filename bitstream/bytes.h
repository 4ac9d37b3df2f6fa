// Bytes in and out: little-endian numbers, variable-length integers, and a reader that remembers
// errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

/// Least-significant seven bits first, high bit set on all bytes but the last; 1 .. 10 bytes, no
/// padding (the last byte is 0 only for the value 0).
void append_varuint(std::vector<uint8_t>& out, uint64_t value);

void append_u32(std::vector<uint8_t>& out, uint32_t value);
void append_f32(std::vector<uint8_t>& out, float value);

/// A count n of 0 .. 8, then the n most significant bytes of the binary64 value, most significant
/// first; the bytes left out are 0. Exact for every value, 3 bytes for 30.0.
void append_f64(std::vector<uint8_t>& out, double value);

/// Reads from the front of a span. After the first failure every read gives 0 and `ok()` stays
/// false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  uint8_t u8();
  uint32_t u32();
  uint64_t varuint();
  float f32();
  double f64();
  std::span<const uint8_t> take(uint64_t count);

  bool ok() const { return ok_; }
  /// True when the failure was a lack of bytes, false when the bytes were wrong.
  bool ran_out() const { return ran_out_; }
  size_t position() const { return position_; }
  size_t remaining() const { return bytes_.size() - position_; }

 private:
  void fail(bool ran_out);

  std::span<const uint8_t> bytes_;
  size_t position_ = 0;
  bool ok_ = true;
  bool ran_out_ = false;
};

}  // namespace reeb
