// The boxes that decoded groups lie in.
#pragma once

#include <cstdint>
#include <span>

#include "bitstream/attribute_headers.h"
#include "bitstream/status.h"

namespace reeb {

/// Decodes a whole file and finds the box of each group.
Status find_bounds(std::span<const uint8_t> file, unsigned threads, GroupBoxes& out);

}  // namespace reeb
