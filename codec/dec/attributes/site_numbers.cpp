#include "codec/dec/attributes/site_numbers.h"

namespace reeb {

Status copy_numbers(const SiteNumbers& from, const std::vector<uint32_t>* order,
                    const ValueTarget& target) {
  const size_t count = order != nullptr ? order->size() : from.element_count();
  const size_t stride = target.stride == 0 ? from.bytes : target.stride;
  if ((target.values == nullptr && count > 0) || stride < from.bytes ||
      count > target.element_capacity)
    return Status::invalid(
        "no place for the values, a stride below an element, or too little room");
  for (size_t i = 0; i < count; ++i)
    std::memcpy(target.values + i * stride, from.element(order != nullptr ? (*order)[i] : i),
                from.bytes);
  return {};
}

void append_numbers(const SiteNumbers& from, std::vector<uint8_t>& values) {
  const size_t count = from.element_count(), at = values.size();
  values.resize(at + count * from.bytes);
  for (size_t e = 0; e < count; ++e)
    std::memcpy(&values[at + e * from.bytes], from.element(e), from.bytes);
}

}  // namespace reeb
