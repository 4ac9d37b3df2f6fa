// Where a shot is cut into groups.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/enc/encoder.h"

namespace reeb {

struct GroupPlan {
  std::vector<uint32_t> lengths;  ///< frames of each group
  uint32_t open_groups = 0;       ///< in a row, that continue the group before
};

/// As the options ask for or as suits the shot: groups that are soon decoded, a few in a row of
/// which may continue each other.
GroupPlan plan_groups(const Shot& shot, const EncodeOptions& options);

}  // namespace reeb
