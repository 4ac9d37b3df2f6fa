#include "entropy/interval_coder.h"

#include <utility>

namespace reeb {

// Where the sum overflows, the bytes before take the carry.
void IntervalEncoder::add(uint64_t below) {
  low_ += below;
  if (low_ >= below) return;
  for (size_t i = bytes_.size(); i-- > 0 && ++bytes_[i] == 0;) {
  }
}

void IntervalEncoder::shift() {
  for (; range_ >> 56 == 0; range_ <<= 8) {
    bytes_.push_back(static_cast<uint8_t>(low_ >> 56));
    low_ <<= 8;
  }
}

void IntervalEncoder::code(const Interval& interval) {
  const uint64_t unit = range_ / interval.whole;
  const uint64_t below = unit * interval.below;
  const bool last = interval.below + interval.size == interval.whole;
  add(below);
  range_ = last ? range_ - below : unit * interval.size;
  shift();
}

bool IntervalEncoder::code(bool bit, Probability p1) {
  const uint64_t bound = (range_ >> 16) * p1;
  if (!bit) add(bound);
  range_ = bit ? bound : range_ - bound;
  shift();
  return bit;
}

std::vector<uint8_t> IntervalEncoder::finish() {
  // Any number in [low, low + range) will do; the one with most trailing zero bits needs fewest
  // bytes.
  uint64_t step = 0;
  for (int bits = 63; bits > 0; --bits) {
    const uint64_t mask = (uint64_t{1} << bits) - 1;
    step = (0 - low_) & mask;  // to the next multiple of 2^bits
    if (step < range_) break;
  }
  add(step);
  // A decoder that reads these decisions shifts in this many bytes behind its first eight; with
  // fewer it would take the code for a cut one.
  const size_t least = bytes_.size();
  for (; low_ != 0; low_ <<= 8) bytes_.push_back(static_cast<uint8_t>(low_ >> 56));
  while (bytes_.size() > least && bytes_.back() == 0) bytes_.pop_back();
  return std::move(bytes_);
}

IntervalDecoder::IntervalDecoder(std::span<const uint8_t> bytes) : in_(bytes) {
  for (int i = 0; i < 8; ++i) code_ = code_ << 8 | in_.next();
}

}  // namespace reeb
