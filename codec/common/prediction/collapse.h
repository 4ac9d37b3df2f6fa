// Coarse-to-fine order of a mesh by half-edge collapses in independent sets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/fixed_list.h"
#include "codec/common/base/stop.h"
#include "codec/common/mesh/grid.h"

namespace reeb {

/// One removed vertex and what surrounded it at that moment; all of it is still there when the
/// collapses are undone in reverse, that is when the vertex is decoded.
struct Collapse {
  uint32_t vertex = 0;
  FixedList<uint32_t, 16> ring;   ///< its neighbours, by index
  FixedList<uint32_t, 16> extra;  ///< nearest vertices of the 2-ring, then of the 3-ring, each by
                                  ///< distance
};

struct CollapseSequence {
  std::vector<Collapse> collapses;  ///< in the order of removal: fine to coarse
  std::vector<uint32_t> base;       ///< what is left, by index; isolated vertices are not among it
  std::vector<uint32_t> isolated;   ///< vertices without a triangle, by index
};

/// `triangles` holds 3 vertex indices each, non-degenerate; any topology. `max_extra` (at most
/// 16) bounds `extra`. Integer keys only, ties by index: the same on every machine. Time O(V log
/// V).
CollapseSequence collapse_mesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t max_extra, const StopToken& stop = {});

}  // namespace reeb
