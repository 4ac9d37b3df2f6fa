// The Reeb graph as a skeleton that moves with the animation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/segmentation.h"

namespace reeb::segmentation {

/// Where the graph is in space in one frame.
struct Skeleton {
  /// Per node of the graph: an extremity's own vertex, a branching's body, or the middle of the
  /// borders of the regions that meet there.
  std::vector<std::array<float, 3>> nodes;
  /// Per arc of the graph, the centroid of its region's vertices.
  std::vector<std::array<float, 3>> arcs;
};

/// The skeleton of `segmentation` in a frame of the same mesh; `frame` holds V x (x, y, z), finite.
Skeleton place_skeleton(const Result& segmentation, std::span<const uint32_t> triangles,
                        std::span<const float> frame);

}  // namespace reeb::segmentation
