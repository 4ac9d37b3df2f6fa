// The numbers that the coded integers of an attribute stand for.
#pragma once

#include <bit>
#include <cstdint>

#include "bitstream/attribute_headers.h"
#include "bitstream/status.h"
#include "codec/common/base/attributes.h"

namespace reeb {

/// The bits of a binary32 as an integer that rises with the number, and back.
inline uint32_t ordered_bits(uint32_t bits) {
  return (bits >> 31) != 0 ? ~bits : bits | uint32_t{1} << 31;
}
inline uint32_t bits_of_ordered(uint32_t ordered) {
  return (ordered >> 31) != 0 ? ordered & ~(uint32_t{1} << 31) : ~ordered;
}

/// Smallest and largest number of an integer type.
struct IntegerRange {
  int64_t low, high;
};
IntegerRange integer_range(ValueType type);

/// kCorrupt where a channel of `type` cannot have such numbers.
Status check_channel(ValueType type, const ChannelHeader& channel);

/// Integer n of a binary32 channel, as bits.
inline uint32_t binary32_bits(const ChannelHeader& c, uint32_t n) {
  if (c.numbers == ChannelHeader::Numbers::kBinary32)
    return bits_of_ordered(static_cast<uint32_t>(c.low() + n));
  const auto multiple = static_cast<double>(c.low() + n);
  return std::bit_cast<uint32_t>(static_cast<float>(multiple * c.step));
}

/// Integer n of a channel of an integer type, whose steps are whole numbers.
inline int64_t integer_number(ValueType type, const ChannelHeader& c, uint32_t n) {
  const IntegerRange range = integer_range(type);
  const int64_t number = (c.low() + n) * static_cast<int64_t>(c.step);
  return number < range.low ? range.low : number > range.high ? range.high : number;
}

}  // namespace reeb
