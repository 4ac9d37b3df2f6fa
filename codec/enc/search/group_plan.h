// Where a shot is cut into groups.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

/// Frames of each group of a shot, as the options ask for or as suits it.
std::vector<uint32_t> plan_groups(const Shot& shot, const EncodeOptions& options);

}  // namespace reeb
