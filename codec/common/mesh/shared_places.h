// Which points of a mesh lie where others do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

struct NumberedPlaces {
  static constexpr uint32_t kNone = UINT32_MAX;
  std::vector<uint32_t> of_point;  ///< below `count`; kNone for nearly all points that lie alone
  uint32_t count = 0;
};
/// The places of [point][xyz] that points share. Time O(n log n) for any points.
NumberedPlaces number_places(std::span<const int32_t> grid);

/// 1 for every point of [point][xyz] that lies where another one does; 0 for nearly all others.
std::vector<uint8_t> shared_places(std::span<const int32_t> grid);

}  // namespace reeb
