#include "codec/common/attributes/numbers.h"

#include <cmath>
#include <limits>

namespace reeb {

IntegerRange integer_range(ValueType type) {
  switch (type) {
    case ValueType::kU8:
    case ValueType::kU8Normalised:
      return {0, 255};
    case ValueType::kU16:
    case ValueType::kU16Normalised:
      return {0, 65535};
    case ValueType::kBinary32:
    case ValueType::kI32:
      break;
  }
  return {std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max()};
}

Status check_channel(ValueType type, const ChannelHeader& c) {
  const auto wrong = [] {
    return Status::corrupt("attr: the numbers of a channel do not fit its type");
  };
  const int64_t high = c.low() + static_cast<int64_t>(c.top);
  if (c.numbers == ChannelHeader::Numbers::kBinary32) {
    const bool fits = c.low() >= 0 && high <= std::numeric_limits<uint32_t>::max();
    return type == ValueType::kBinary32 && fits ? Status() : wrong();
  }
  const double largest =
      std::max(std::abs(static_cast<double>(c.low())), std::abs(static_cast<double>(high)));
  if (type == ValueType::kBinary32)
    return largest * c.step <= ChannelHeader::kMaxNumber ? Status() : wrong();
  constexpr double kMaxStep = 1 << 16;
  return c.step >= 1 && c.step <= kMaxStep && c.step == std::floor(c.step) ? Status() : wrong();
}

}  // namespace reeb
