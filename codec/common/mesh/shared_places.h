// Which points of a mesh lie where others do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

/// 1 for every point of [point][xyz] that lies where another one does; 0 for nearly all others.
std::vector<uint8_t> shared_places(std::span<const int32_t> grid);

}  // namespace reeb
