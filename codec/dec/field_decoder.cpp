#include "codec/dec/field_decoder.h"

#include <cmath>

#include "codec/common/base/largest_magnitude.h"
#include "entropy/range_coder.h"

namespace reeb {

namespace {

/// False when the bytes do not suffice or a value is beyond binary32.
bool decode_component(Field& field, BinaryDecoder& decoder) {
  BinaryDecoder local = decoder;  // of which the compiler knows that nothing else changes it
  field.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
    return field.model().code(local, bins, 0);
  });
  decoder = local;
  const std::vector<float>& plane = field.plane(field.component_count() - 1);
  return std::isfinite(largest_magnitude(plane)) && !decoder.overrun();
}

}  // namespace

bool decode_field(std::span<const uint8_t> section, uint32_t count, Field& field,
                  const StopToken& stop) {
  BinaryDecoder decoder(section);
  for (uint32_t k = 0; k < count; ++k) {
    if (stop.requested() || !decode_component(field, decoder)) return false;
  }
  return true;
}

}  // namespace reeb
