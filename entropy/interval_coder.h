// Range coder of integers whose distributions are given as intervals, and of bits besides.
//
// Its range has 64 bits, so that an integer takes one step, whatever the whole that its interval
// lies in. As with the binary range coder, syntax written once as a template serves both
// directions.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/byte_input.h"
#include "entropy/range_coder.h"

namespace reeb {

/// The part [below, below + size) of [0, whole) that belongs to an integer, whose probability is
/// size / whole. 0 < size <= whole < 2^56.
struct Interval {
  uint64_t below, size, whole;
};

class IntervalEncoder {
 public:
  void code(const Interval& interval);
  /// Codes `bit`, whose probability of being 1 is `p1`; returns `bit`.
  bool code(bool bit, Probability p1);

  /// Ends the code with as few bytes as tell it from any other (a decoder reads zeros past the
  /// end) and keep `IntervalDecoder::overrun` false.
  std::vector<uint8_t> finish();

 private:
  void add(uint64_t below);
  void shift();

  std::vector<uint8_t> bytes_;
  uint64_t low_ = 0;
  uint64_t range_ = UINT64_MAX;
};

class IntervalDecoder {
 public:
  explicit IntervalDecoder(std::span<const uint8_t> bytes);

  /// A place in the interval of the next integer, which `code` is then to take; below `whole`.
  uint64_t find(uint64_t whole) const { return std::min(code_ / (range_ / whole), whole - 1); }
  void code(const Interval& interval) {
    const uint64_t unit = range_ / interval.whole;
    const uint64_t below = unit * interval.below;
    const bool last = interval.below + interval.size == interval.whole;  // takes what is left over
    code_ -= below;
    range_ = last ? range_ - below : unit * interval.size;
    shift();
  }
  /// Decodes one bit; the first argument is ignored.
  bool code(bool /*bit*/, Probability p1) {
    const uint64_t bound = (range_ >> 16) * p1;
    const bool bit = code_ < bound;
    code_ -= bit ? 0 : bound;
    range_ = bit ? bound : range_ - bound;
    shift();
    return bit;
  }

  /// True once more bytes were needed than a well-formed code of this length can need.
  bool overrun() const { return in_.taken() > in_.size() + 8; }

 private:
  void shift() {
    for (; range_ >> 56 == 0; range_ <<= 8) code_ = code_ << 8 | in_.next();
  }

  ByteInput in_;
  uint64_t code_ = 0;
  uint64_t range_ = UINT64_MAX;
};

}  // namespace reeb
