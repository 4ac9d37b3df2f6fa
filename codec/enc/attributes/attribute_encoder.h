// Encoder of attributes.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/attribute_headers.h"
#include "bitstream/status.h"
#include "codec/common/attributes/site_mesh.h"
#include "codec/common/base/attributes.h"

namespace reeb {

/// An attribute as chunk `attr` holds it; shot and index are still to be set.
struct CodedAttribute {
  AttributeHeader header;
  AttributeBody body;
  std::vector<uint8_t> section;
};

/// Header of an attribute but for shot and index.
AttributeHeader header_of(const Attribute& attribute);

/// Encodes a static attribute whose values are in output order, complete and of finite error
/// bounds.
Status encode_static_attribute(const Attribute& attribute, const ShotSurface& surface,
                               CodedAttribute& out);

}  // namespace reeb
