// Figures: shapes of many kinds, of each as many individuals as one likes, in as many poses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// Names of the kinds: creatures with limbs, and things.
const std::vector<std::string>& figure_kinds();

/// Individual `individual` of a kind (one of figure_kinds()) in `frame_count` (>= 1) poses, each a
/// closed mesh of its own of some 5,000 vertices, not manifold where parts touch. Individuals
/// differ in proportions, things in their build as well; what has no joints has the same shape in
/// every pose.
Sequence make_figure(const std::string& kind, uint32_t individual, uint32_t frame_count);

}  // namespace reeb::tools
