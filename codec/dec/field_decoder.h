// Decoder of a section that holds a field.
#pragma once

#include <cstdint>
#include <span>

#include "codec/common/base/stop.h"
#include "codec/common/fields/field.h"

namespace reeb {

/// Decodes `count` components of the section; false where it is damaged, or `stop` is requested.
bool decode_field(std::span<const uint8_t> section, uint32_t count, Field& field,
                  const StopToken& stop = {});

}  // namespace reeb
