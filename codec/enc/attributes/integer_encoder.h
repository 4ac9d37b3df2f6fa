// Encoder of an attribute's integers, with the mirror plane that pays.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/attributes/attribute_syntax.h"

namespace reeb {

/// Adds the integers of `sites`, [site][channel], to what `coder` has.
Status encode_integers(const AttributeHeader& header, const AttributeBody& body,
                       const ShotSurface& surface, const SiteMesh& sites,
                       std::vector<uint32_t>& integers, IntervalEncoder& coder);

}  // namespace reeb
