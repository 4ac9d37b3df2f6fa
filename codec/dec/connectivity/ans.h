// Asymmetric numeral systems as connectivity has them: bits of one probability, and symbols of a
// few with probabilities of 1/4096. Bytes are taken from the end.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bitstream/bytes.h"

namespace reeb {

/// The state of a code of this kind.
class AnsState {
 public:
  /// Reads the first state, which the last bytes hold, at most `most_bytes` of them. False where
  /// they do not.
  bool open(std::span<const uint8_t> bytes, uint32_t base, uint32_t most_bytes);

  /// The state before a bit or symbol is decoded, not below the base.
  uint32_t filled() {
    while (value_ < base_) {
      if (bytes_.empty()) {
        overrun_ = true;
        return base_;
      }
      value_ = value_ << 8 | bytes_.back();
      bytes_ = bytes_.first(bytes_.size() - 1);
    }
    return value_;
  }
  void set(uint32_t value) { value_ = value; }

  /// True where all bytes are read, none more than once, and nothing is left in the state.
  bool at_end() { return filled() == base_ && bytes_.empty() && !overrun_; }

 private:
  std::span<const uint8_t> bytes_;
  uint32_t base_ = 0;
  uint32_t value_ = 0;
  bool overrun_ = false;
};

class AnsBits {
 public:
  /// Reads the probability of 0 and takes the code. False where they are malformed.
  bool open(ByteReader& in);
  bool next();
  bool at_end() { return state_.at_end(); }

 private:
  AnsState state_;
  uint32_t zeros_ = 0;  ///< of 256
};

class AnsSymbols {
 public:
  static constexpr uint32_t kMaxSymbols = 5;

  /// Reads the probabilities of 1 to `most_symbols` symbols and takes the code. False where they
  /// are malformed.
  bool open(ByteReader& in, uint32_t most_symbols);
  uint8_t next();
  bool at_end() { return state_.at_end(); }

 private:
  bool read_probabilities(ByteReader& in, uint32_t most_symbols);

  AnsState state_;
  std::array<uint32_t, kMaxSymbols + 1> below_ = {};  ///< sum of the probabilities before each
};

}  // namespace reeb
