// Coordinates so far from all others that they would spoil grid and steps for them.
#pragma once

#include <optional>

#include "codec/common/base/sequence.h"

namespace reeb {

/// The sequence with its outliers moved to the rest, for coding under corrections that move them
/// back; nothing where there are none.
std::optional<Sequence> without_outliers(const Sequence& sequence);

}  // namespace reeb
