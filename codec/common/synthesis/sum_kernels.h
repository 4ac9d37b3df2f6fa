// The sum of components, for many vertices at a time.
#pragma once

#include <cstdint>

namespace reeb {

inline constexpr uint32_t kTileRows = 64;

/// The components of kTileRows vertices, all of which lie together, so that reading them is what
/// memory does best. Plain pointers: inline members of containers, compiled for one instruction
/// set, could be linked in for all.
struct ComponentTile {
  const float* wide;  ///< [component][vertex]
  uint32_t wide_count;
  const uint32_t* narrow;  ///< [pair][vertex]: two components, 16 bits each, signed
  uint32_t pair_count;
};

/// What the components count in one frame.
struct FrameBasis {
  const float* wide;       ///< [axis][component]
  const uint32_t* narrow;  ///< [axis][pair]
  float unit;              ///< of the narrow components' sum
  const double* mean;      ///< of each axis
};

struct SumKernels {
  /// Writes the positions of a tile's vertices, xyz after xyz. For each axis: sum = 0 + wide[0] *
  /// tile.wide[0] + wide[1] * tile.wide[1] + ... in binary32, in this order; sum + unit * float(the
  /// sum of the narrow products, which is within 32 bits); mean + sum in binary64, rounded.
  void (*combine)(const ComponentTile& tile, const FrameBasis& basis, float* xyz);
};

}  // namespace reeb
