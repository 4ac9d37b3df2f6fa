#include "codec/common/mesh/shared_places.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace reeb {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
/// Places of the table that are looked at; a point that finds no room passes for a shared one, as
/// do all that lie where it does. No mesh can make this slow.
constexpr uint32_t kMaxTries = 32;

uint64_t place_of(const int32_t* xyz) {
  return static_cast<uint64_t>(xyz[0]) << 32 | static_cast<uint64_t>(xyz[1]) << 16 |
         static_cast<uint64_t>(xyz[2]);
}

uint32_t hash(const int32_t* xyz) {
  return static_cast<uint32_t>(place_of(xyz) * 0x9E3779B97F4A7C15 >> 32);
}

}  // namespace

std::vector<uint8_t> shared_places(std::span<const int32_t> grid) {
  const size_t count = grid.size() / 3;
  const size_t mask = std::bit_ceil(2 * count + 1) - 1;
  std::vector<uint32_t> point_at(mask + 1, kNone);
  std::vector<uint8_t> shared(count);
  for (uint32_t p = 0; p < count; ++p) {
    const int32_t* const xyz = &grid[size_t{p} * 3];
    size_t at = hash(xyz) & mask;
    shared[p] = 1;
    for (uint32_t tries = 0; tries < kMaxTries; ++tries, at = (at + 1) & mask) {
      const uint32_t other = point_at[at];
      if (other == kNone) {
        point_at[at] = p;
        shared[p] = 0;
        break;
      }
      if (!std::equal(xyz, xyz + 3, &grid[size_t{other} * 3])) continue;
      shared[other] = 1;
      break;
    }
  }
  return shared;
}

// Most points lie alone; sorting the others takes no longer where somebody has chosen their places.
NumberedPlaces number_places(std::span<const int32_t> grid) {
  const std::vector<uint8_t> shared = shared_places(grid);
  std::vector<std::pair<uint64_t, uint32_t>> sorted;  // place, point
  for (uint32_t p = 0; p < shared.size(); ++p) {
    if (shared[p] != 0) sorted.emplace_back(place_of(&grid[size_t{p} * 3]), p);
  }
  std::sort(sorted.begin(), sorted.end());
  NumberedPlaces out;
  out.of_point.assign(shared.size(), NumberedPlaces::kNone);
  for (size_t i = 0; i < sorted.size(); ++i) {
    if (i == 0 || sorted[i].first != sorted[i - 1].first) ++out.count;
    out.of_point[sorted[i].second] = out.count - 1;
  }
  return out;
}

}  // namespace reeb
