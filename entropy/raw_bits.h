// Bits at even odds, packed without a model: a section of its own beside a range code, so that what
// nobody can predict costs no time either.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "entropy/byte_input.h"

namespace reeb {

/// Appends integers of 0 to 32 bits, the lowest bit first, to bytes filled from their lowest bit.
class RawBitWriter {
 public:
  /// Writes the low `count` bits of `value`, the others must be 0; returns `value`.
  uint32_t code(uint32_t value, uint32_t count) {
    held_ |= uint64_t{value} << used_;
    used_ += count;
    while (used_ >= 8) {
      bytes_.push_back(static_cast<uint8_t>(held_));
      held_ >>= 8;
      used_ -= 8;
    }
    return value;
  }

  /// The bytes, the last one filled up with zeros.
  std::vector<uint8_t> finish() {
    if (used_ > 0) bytes_.push_back(static_cast<uint8_t>(held_));
    held_ = used_ = 0;
    return std::move(bytes_);
  }

 private:
  std::vector<uint8_t> bytes_;
  uint64_t held_ = 0;  ///< bits not written yet, fewer than 8 between calls
  uint32_t used_ = 0;
};

class RawBitReader {
 public:
  explicit RawBitReader(std::span<const uint8_t> bytes) : in_(bytes) {}

  /// Reads `count` (0 .. 32) bits; the first argument is ignored. Past the end there are zeros.
  uint32_t code(uint32_t /*value*/, uint32_t count) {
    while (used_ < count) {
      held_ |= uint64_t{in_.next()} << used_;
      used_ += 8;
    }
    const auto value = static_cast<uint32_t>(held_ & ((uint64_t{1} << count) - 1));
    held_ >>= count;
    used_ -= count;
    return value;
  }

  /// True once more bits were read than there are.
  bool overrun() const { return in_.taken() > in_.size(); }
  /// True where all bytes are read and the bits left of the last one are 0.
  bool at_end() const { return in_.taken() == in_.size() && held_ == 0; }

 private:
  ByteInput in_;
  uint64_t held_ = 0;
  uint32_t used_ = 0;
};

}  // namespace reeb
