// The payload of chunk `GRUP`, which animated attributes have inside their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/container.h"

namespace reeb {

/// Header and sections; spans of `out` point into `payload`.
Status read_group_payload(std::span<const uint8_t> payload, GroupChunk& out);
/// Appends them. The section lengths of `header` are taken from the spans.
Status write_group_payload(const GroupHeader& header, const GroupSections& sections,
                           std::vector<uint8_t>& out);

}  // namespace reeb
