// The reference mesh of a shot, as the stream carries it: connectivity, positions on an integer
// grid, and where each coded vertex goes in the output.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb {

/// Largest position on the grid, per axis.
inline constexpr int32_t kGridMax = 65535;

/// A decoded reference mesh. *Coding numbering* is the order in which the stream introduces
/// vertices: points as the edgebreaker numbers them, then all others.
struct ReferenceMesh {
  uint32_t vertex_count = 0;
  Connectivity connectivity;  ///< in output numbering; face order and first corners are free
  std::vector<int32_t> grid;  ///< [coding vertex][xyz], 0 .. kGridMax
  std::vector<uint32_t>
      triangles;       ///< three coding vertices each, all different; every face as a fan
  bool plain = false;  ///< coded to be quick to decode, for the fast profile
  std::vector<uint32_t> output_index;  ///< output vertex of each coding vertex, a permutation
};

}  // namespace reeb
