#include "entropy/range_coder.h"

#include <utility>

namespace reeb {

namespace {
constexpr uint32_t kTop = 1u << 24;
}

bool BinaryEncoder::code(bool bit, Probability p1) {
  const auto bound = static_cast<uint32_t>((uint64_t{range_} * p1) >> 16);
  if (bit) {
    range_ = bound;
  } else {
    low_ += bound;
    range_ -= bound;
  }
  while (range_ < kTop) {
    shift_low();
    range_ <<= 8;
  }
  return bit;
}

void BinaryEncoder::shift_low() {
  const bool carry = (low_ >> 32) != 0;
  const auto top = static_cast<uint8_t>(low_ >> 24);
  // Unless the new byte is 0xFF no later carry can reach the cached bytes: they are final.
  if (carry || top != 0xFF || cache_size_ == 0) {
    if (cache_size_ > 0) bytes_.push_back(static_cast<uint8_t>(cache_ + (carry ? 1 : 0)));
    for (uint64_t i = 1; i < cache_size_; ++i) bytes_.push_back(carry ? 0x00 : 0xFF);
    cache_ = top;
    cache_size_ = 0;
  }
  ++cache_size_;
  low_ = (low_ & 0x00FFFFFF) << 8;
}

std::vector<uint8_t> BinaryEncoder::finish() {
  // Any value in [low, low + range) will do; the one with most trailing zero bits needs fewest
  // bytes.
  const uint64_t last = low_ + range_ - 1;
  for (int bits = 32; bits >= 0; --bits) {
    const uint64_t value = last >> bits << bits;
    if (value >= low_) {
      low_ = value;
      break;
    }
  }
  // A decoder that reads these decisions shifts in this many bytes behind its first four; with
  // fewer it would take the code for a cut one.
  const uint64_t least = bytes_.size() + cache_size_;
  for (int i = 0; i < 5; ++i) shift_low();
  while (bytes_.size() > least && bytes_.back() == 0) bytes_.pop_back();
  return std::move(bytes_);
}

BinaryDecoder::BinaryDecoder(std::span<const uint8_t> bytes) : in_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | in_.next();
}

}  // namespace reeb
