// The Reeb graph as a skeleton that moves with the animation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/segmentation.h"

namespace reeb::segmentation {

using Position = std::array<float, 3>;

/// Where the graph is in space in one frame.
struct SkeletonPose {
  std::vector<Position> nodes;  ///< per node of the graph
  std::vector<std::vector<Position>>
      arcs;                       ///< per arc, points between its nodes from `from` to `to`
  std::vector<Position> regions;  ///< per region, its centroid
};

/// The parts of the mesh that each point of the skeleton is the mean of, weighted by area. They are
/// chosen on the reference and then followed, so that the skeleton of a frame is that of the
/// reference in another pose.
class Skeleton {
 public:
  /// `segmentation` is that of the mesh of `positions` (V x (x, y, z)) and `triangles`.
  Skeleton(const Result& segmentation, std::span<const float> positions,
           std::span<const uint32_t> triangles);

  /// The skeleton in a frame, V x (x, y, z), all finite.
  SkeletonPose place(std::span<const float> frame) const;

 private:
  using Vertices = std::vector<uint32_t>;

  std::vector<double> areas_;  // per vertex of the reference
  std::vector<Vertices> nodes_, regions_;
  std::vector<std::vector<Vertices>> arcs_;  // none of the innermost is empty
};

}  // namespace reeb::segmentation
