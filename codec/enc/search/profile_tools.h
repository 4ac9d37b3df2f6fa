// What the search for the cheapest stream needs to know of a profile.
#pragma once

#include <memory>

#include "bitstream/profile.h"
#include "codec/enc/fields/group_encoder.h"

namespace reeb {

/// When regions of the motion model are tried, where the caller leaves their number open.
enum class RegionUse {
  kThorough,   ///< only at efforts that try it everywhere
  kPieces,     ///< also on meshes of several pieces
  kReebGraph,  ///< not tried: the regions of the Reeb graph are used as they are
};

struct ProfileTools {
  std::unique_ptr<GroupEncoder> (*make_encoder)(GroupSignal signal, unsigned threads);
  bool plain_mesh = false;   ///< the reference mesh is plain, unless another pays much better
  bool learns = false;       ///< weights, from a prior that may be weak
  bool open_groups = false;  ///< groups may continue each other
  /// Where it is smaller, a bounded error is met by moving coordinates to multiples, and any target
  /// by coding without a loss.
  bool goes_lossless = false;
  RegionUse regions = RegionUse::kThorough;
};

/// Of a profile with components: any but the lossless one.
const ProfileTools& tools_of(Profile profile);

}  // namespace reeb
