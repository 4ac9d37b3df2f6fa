// Regions that follow the motion of a sequence, for affine motion compensation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/segmentation.h"

namespace reeb::segmentation {

/// A mesh of V vertices and its animation. All spans outlive the calls they are given to.
struct MotionInput {
  std::span<const float>
      positions;  ///< V x (x, y, z) of the reference, which the affine maps act on
  std::span<const uint32_t> triangles;  ///< T x three vertices
  std::span<const float>
      frames;  ///< [frame][vertex][x, y, z], a whole number of frames, all finite
};

/// KG error in percent, 100 ||X - P|| / ||X - mean(X)||, of predicting every frame by the best
/// affine map of the reference per region and frame; the mean is per frame and axis. `labels` has
/// one region per vertex. 0 for a sequence that does not extend in space.
double motion_error(const MotionInput& input, std::span<const uint32_t> labels);

/// Nested partitions from many regions to one, each made by merging the two neighbours whose union
/// costs the least motion-compensation error.
class MotionPartitions {
 public:
  /// Starts from the regions of `segmentation` (of the same mesh) cut into patches of about
  /// `patch_vertices` (at least 5, below which a fit says nothing) vertices. Touching regions may
  /// merge, and pieces that lie side by side.
  MotionPartitions(const MotionInput& input, const Result& segmentation,
                   uint32_t patch_vertices = 8);

  /// Regions of the finest partition; at least one when there are vertices.
  uint32_t finest() const { return finest_; }

  /// Squared error of the partition of `count` regions (1 .. finest()) over a sample of the frames,
  /// in units of the input squared, summed over vertices and scaled to all frames.
  double squared_error(uint32_t count) const { return squared_error_[count - 1]; }

  /// Labels 0 .. count-1 of the partition of `count` regions, 1 .. finest().
  std::vector<uint32_t> labels(uint32_t count) const;

 private:
  struct Merge {
    uint32_t into, from;
  };

  uint32_t finest_ = 0;
  std::vector<uint32_t> patches_;  // per vertex
  std::vector<Merge> merges_;      // from the finest partition on
  std::vector<double> squared_error_;
};

/// Moves vertices between neighbouring regions wherever that lowers the motion-compensation error,
/// in at most `sweeps` alternations of moving and fitting. No region vanishes, and none falls apart
/// that was connected.
std::vector<uint32_t> adjust_borders(const MotionInput& input, std::vector<uint32_t> labels,
                                     uint32_t sweeps = 60);

}  // namespace reeb::segmentation
