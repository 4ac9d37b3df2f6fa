// Coarse-to-fine order of a mesh from its connectivity alone, by contractions in independent sets:
// the surface graph of the fast profile, which is there before any position is.
#pragma once

#include <cstdint>
#include <span>

#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// `triangles` holds 3 vertices below `vertex_count` each, non-degenerate; any topology. Ring and
/// other
/// neighbours are those of the moment of contraction; no links, priors, precisions and steps (see
/// weigh_rows). Time O(V + triangles).
SurfaceGraph contract_mesh(uint32_t vertex_count, std::span<const uint32_t> triangles,
                           const StopToken& stop = {});

}  // namespace reeb
