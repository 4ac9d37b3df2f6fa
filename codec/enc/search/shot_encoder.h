// Encoder of one shot: its reference mesh, its groups, and the settings that a trial may change.
#pragma once

#include <memory>
#include <vector>

#include "bitstream/container.h"
#include "codec/enc/encoder.h"
#include "codec/enc/fields/group_encoder.h"
#include "segmentation/motion.h"

namespace reeb {

/// Sums over decoded frames.
struct ErrorSums {
  double squared = 0;  ///< of the distances of the vertices from where the input has them
  double largest = 0;  ///< of a coordinate
};

class ShotEncoder {
 public:
  /// `shot` must outlive the encoder; `first_frame` is its place in the sequence.
  ShotEncoder(const Shot& shot, uint32_t first_frame, const EncodeOptions& options,
              unsigned threads);

  /// Codes the reference mesh on the grid that suits an RMS error of `error` per coordinate (world
  /// units).
  Status set_grid(double error);
  /// Bits of that grid before rounding, 9 to 16.
  double best_grid_bits(double error) const;
  uint32_t grid_bits() const { return grid_bits_; }
  Status set_grid_bits(uint32_t bits);

  /// Fast profile: whether the reference mesh is plain, which it is at first.
  Status set_plain(bool plain);

  /// The share of the vertices in the largest connected piece of the mesh.
  double largest_piece() const;

  /// Gives the motion model `count` regions, or as many as the shape allows; 0 for none.
  void set_regions(uint32_t count);
  /// Gives the motion model the regions of the Reeb graph as they are.
  void set_reeb_regions();
  uint32_t regions() const { return regions_; }

  /// Bits and squared error to expect at quantization step q, roughly.
  RatePoint expect(double q);

  /// From now on every group sends as many components as in `coded`; empty = as many as pay.
  void hold_components(const std::vector<CodedGroup>& coded);

  /// Lets weights go further from what distances tell.
  void set_weak_prior(bool weak_prior);

  /// Encodes every group with quantization step q.
  std::vector<CodedGroup> encode(double q);

  /// Appends the reference mesh and the groups.
  Status write(uint32_t shot_index, const std::vector<CodedGroup>& coded,
               ContainerWriter& writer) const;

  /// Compares what the decoder will have, to the bit, with the input.
  ErrorSums measure(const std::vector<CodedGroup>& coded) const;

  double energy() const {
    return energy_;
  }  ///< sum of squares about the mean of each frame and axis
  double largest_coefficient() const { return largest_; }  ///< bound on any, world units
  double vertex_frames() const;                            ///< vertices times frames
  double longest_side() const;                             ///< of the first frame's bounding box

 private:
  struct Group {
    uint32_t first_frame;  ///< in the shot
    std::unique_ptr<GroupEncoder> encoder;
    std::unique_ptr<MotionFit> motion;
  };
  /// True where group i starts from what the one before has learned.
  bool continues(uint32_t i) const {
    return profile_ == Profile::kMain && i % (open_groups_ + 1) != 0;
  }
  void fit_motion();
  void correct(const Group& group, CodedGroup& coded) const;
  void segment_reference();

  const Shot& shot_;
  ReferencePlan plan_;
  uint32_t first_frame_;
  bool reorder_;
  Profile profile_;
  bool plain_;
  double bound_;  ///< on the error of every coordinate, world units; 0 = none
  uint32_t open_groups_;
  uint32_t grid_bits_ = 0;
  uint32_t regions_ = 0;
  SurfaceContext surface_;
  uint32_t spare_bits_ = 0;
  SurfaceContext spare_;  ///< the grid before, which a trial may return to
  std::vector<Group> groups_;
  std::vector<uint32_t> triangles_;                     ///< of the input; made with the next two
  std::unique_ptr<segmentation::Result> reeb_regions_;  ///< when first needed
  std::unique_ptr<segmentation::MotionPartitions> partitions_;
  std::vector<uint32_t> labels_;  ///< region of each vertex of the input
  double energy_ = 0;
  double largest_ = 0;
};

}  // namespace reeb
