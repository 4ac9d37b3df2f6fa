// What files say of positions beyond the binary32 values of a Sequence.
#pragma once

#include <vector>

namespace reeb::tools {

/// What a file says less the position, see Real: [shot][frame][vertex][xyz]. A shot whose positions
/// are as the files say has none; no shots at all stand for a sequence like that.
using Remainders = std::vector<std::vector<float>>;

}  // namespace reeb::tools
