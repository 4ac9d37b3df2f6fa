// Binary range coder with 16-bit probabilities.
//
// Encoder and decoder have the same member `code(bit, p1)`, so that syntax written once as a
// template over the coder serves both: the decoder ignores `bit` and returns the decoded one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/byte_input.h"

namespace reeb {

/// Probability of a 1 in units of 1/65536; 1 .. 65535.
using Probability = uint16_t;
inline constexpr Probability kEvenOdds = 1u << 15;

class BinaryEncoder {
 public:
  /// Codes `bit`, whose probability of being 1 is `p1`; returns `bit`.
  bool code(bool bit, Probability p1);

  /// Ends the code with as few bytes as tell it from any other (a decoder reads zeros past the
  /// end) and keep `BinaryDecoder::overrun` false.
  std::vector<uint8_t> finish();

 private:
  void shift_low();

  std::vector<uint8_t> bytes_;
  uint64_t low_ = 0;  ///< bits 0..31 undecided, bit 32 the carry
  uint32_t range_ = 0xFFFFFFFF;
  uint8_t cache_ = 0;  ///< last byte that a carry may still change
  uint64_t cache_size_ =
      0;  ///< the cache and the 0xFF bytes that follow it; 0 before the first byte
};

class BinaryDecoder {
 public:
  explicit BinaryDecoder(std::span<const uint8_t> bytes);

  /// Decodes one bit; the first argument is ignored.
  bool code(bool /*bit*/, Probability p1) {
    const auto bound = static_cast<uint32_t>((uint64_t{range_} * p1) >> 16);
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < kTop) {
      code_ = code_ << 8 | in_.next();
      range_ <<= 8;
    }
    return bit;
  }

  /// True once more bytes were needed than a well-formed code of this length can need.
  bool overrun() const { return in_.taken() > in_.size() + 4; }

 private:
  static constexpr uint32_t kTop = 1u << 24;

  ByteInput in_;
  uint32_t code_ = 0;
  uint32_t range_ = 0xFFFFFFFF;
};

}  // namespace reeb
