// Puts the attributes and resources of a sequence into a file that has its positions.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/enc/attributes/animated_encoder.h"

namespace reeb {

/// True where a sequence has anything beside positions.
bool has_attributes(const Sequence& sequence);

/// kInvalidArgument, with the attribute's name, where one is not as `Attribute` asks.
Status check_attributes(const Sequence& sequence);

/// `file`: the positions of `sequence`, as `encode` makes them; becomes the file
/// with all that the sequence has. Pre-condition: check_attributes.
Status attach_attributes(const Sequence& sequence, const AnimatedOptions& options,
                         std::vector<uint8_t>& file);

}  // namespace reeb
