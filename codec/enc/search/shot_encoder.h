// Encoder of one shot: its reference mesh and its groups.
#pragma once

#include <memory>
#include <vector>

#include "bitstream/container.h"
#include "codec/enc/encoder.h"
#include "codec/enc/fields/group_encoder.h"
#include "codec/enc/search/error_sums.h"
#include "codec/enc/search/profile_tools.h"
#include "segmentation/motion.h"

namespace reeb {

/// How a shot is coded: all that a trial may change, but the step.
struct ShotSettings {
  static constexpr uint32_t kReebRegions = UINT32_MAX;

  uint32_t grid_bits = 0;  ///< of the reference mesh: kMinGridBits .. kMaxGridBits
  bool plain = false;      ///< the reference mesh is; only where the profile allows it
  /// Of the motion model, or as many as the shape allows; 0 = none; kReebRegions = those of the
  /// Reeb graph as they are.
  uint32_t regions = 0;
  bool weak_prior = false;           ///< see GroupSettings
  std::vector<uint32_t> components;  ///< sent by each group; empty = as many as pay

  bool operator==(const ShotSettings&) const = default;
};

/// One encoding of a shot.
struct CodedShot {
  std::shared_ptr<const SurfaceContext> surface;
  std::vector<CodedGroup> groups;
  uint32_t regions = 0;  ///< of the motion model
};

class ShotEncoder {
 public:
  static constexpr uint32_t kMinGridBits = 9, kMaxGridBits = 16;

  /// `base` is what is coded, `shot` what corrections make of it, the same where there are none;
  /// both must outlive the encoder. `first_frame` is its place in the sequence.
  ShotEncoder(const Shot& shot, const Shot& base, uint32_t first_frame,
              const EncodeOptions& options, unsigned threads);

  /// Bits of the grid that suits an RMS error of `error` per coordinate (world units), before
  /// rounding.
  double best_grid_bits(double error) const;

  /// Codes the reference mesh. Only the last one, and those of codings that are still around, are
  /// kept.
  Status prepare(const ShotSettings& settings);

  /// Bits and squared error to expect at quantization step q, roughly. The settings were prepared.
  RatePoint expect(const ShotSettings& settings, double q);

  /// Encodes every group with quantization step q.
  Status encode(const ShotSettings& settings, double q, CodedShot& out);

  /// Appends the reference mesh and the groups.
  Status write(uint32_t shot_index, const CodedShot& coded, ContainerWriter& writer) const;

  /// Compares what the decoder will have, to the bit, with the input.
  ErrorSums measure(const CodedShot& coded) const;

  double energy() const {
    return energy_;
  }  ///< of the base: sum of squares about the mean of each frame and axis
  double largest_coefficient() const { return largest_; }  ///< bound on any, world units
  double vertex_frames() const;                            ///< vertices times frames
  double longest_side() const { return longest_side_; }    ///< of the first frame's bounding box

 private:
  struct Group {
    uint32_t first_frame;  ///< in the shot
    std::unique_ptr<GroupEncoder> encoder;
  };
  using SharedSurface = std::shared_ptr<const SurfaceContext>;
  struct MadeSurface {
    uint32_t grid_bits;
    bool plain;
    std::weak_ptr<const SurfaceContext> surface;
  };
  /// The motion of all groups, fitted on a surface.
  struct Motion {
    SharedSurface surface;
    uint32_t wanted = 0;  ///< regions, as in the settings
    uint32_t regions = 0;
    std::vector<std::unique_ptr<MotionFit>> fits;  ///< of each group; empty where none is used
  };

  /// True where group i starts from what the one before has learned.
  bool continues(uint32_t i) const { return i % (open_groups_ + 1) != 0; }
  GroupSettings group_settings(const ShotSettings& settings, double q, size_t group) const;
  GroupHeader header_of(const CodedGroup& coded, uint32_t group) const;
  void fit_motion(uint32_t wanted);
  std::vector<uint32_t> find_regions(uint32_t wanted, uint32_t& count);
  void correct(const Group& group, CodedGroup& coded) const;

  const Shot& shot_;
  const Shot& base_;
  ReferencePlan plan_;
  uint32_t first_frame_;
  bool reorder_;
  Profile profile_;
  StopToken stop_;
  double bound_;  ///< on the error of every coordinate, world units; 0 = none
  uint32_t open_groups_ = 0;
  std::vector<Group> groups_;
  std::vector<MadeSurface> made_;
  SharedSurface surface_;                               ///< prepared last
  Motion motion_;                                       ///< fitted last
  std::vector<uint32_t> triangles_;                     ///< of the input; made with the next two
  std::unique_ptr<segmentation::Result> reeb_regions_;  ///< when first needed
  std::unique_ptr<segmentation::MotionPartitions> partitions_;
  double energy_ = 0;
  double largest_ = 0;
  double longest_side_ = 0;
};

/// The share of the vertices in the largest connected piece of a mesh.
double largest_piece(const Connectivity& mesh);

}  // namespace reeb
