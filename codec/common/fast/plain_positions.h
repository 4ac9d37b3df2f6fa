// Positions of a plain reference mesh (fast profile): each vertex where the parallelograms over its
// known triangles put it, in integers whose classes tell how well that went nearby.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/mesh/mesh_walk.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {

class PlainPositions {
 public:
  using Point = std::array<int32_t, 4>;  ///< x, y, z, 0

  /// What is expected of a vertex: its grid position, and the class of each axis' difference.
  struct Guess {
    Point place, cls;
  };

  explicit PlainPositions(const MeshWalk& walk)
      : walk_(walk), points_(walk.turns()), magnitudes_(walk.turns()) {}

  Guess guess(uint32_t turn) const;
  /// Takes the position, on the grid, that the guess missed by `difference`.
  void note(uint32_t turn, const Point& position, const Point& difference);

 private:
  const MeshWalk& walk_;
  std::vector<Point> points_;  ///< of each turn
  std::vector<Point> magnitudes_;
  Point running_ = {};  ///< decaying means of the magnitudes, in 1/256
};

/// Codes the grid positions, [vertex][xyz]; false where one is off the grid. `Coder` is a
/// RansEncoder or RansDecoder of three lanes.
template <class Coder>
bool code_plain_positions(Coder& coder, const MeshWalk& walk, std::vector<int32_t>& grid) {
  PlainPositions positions(walk);
  for (uint32_t turn = 0; turn < walk.turns(); ++turn) {
    const PlainPositions::Guess guess = positions.guess(turn);
    PlainPositions::Point position{}, difference{};
    int32_t* const xyz = &grid[size_t{walk.order[turn]} * 3];
    for (uint32_t a = 0; a < 3; ++a) {
      const auto cls = static_cast<uint32_t>(guess.cls[a]);
      difference[a] = coder.code(a, cls, xyz[a] - guess.place[a]);
      xyz[a] = position[a] = guess.place[a] + difference[a];
      if (xyz[a] < 0 || xyz[a] > kGridMax) return false;
    }
    positions.note(turn, position, difference);
  }
  return true;
}

}  // namespace reeb
