// What makes a mesh coarse alike, with its positions (collapse.h) and without (contraction.h):
// levels of vertices that are not next to each other are removed, until little is left or goes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace reeb {

inline constexpr uint32_t kBaseSize = 64;   ///< vertices that are left
inline constexpr uint32_t kMaxValence = 9;  ///< of a removed vertex

/// False where a level has removed fewer than one in 200 of the vertices that it has left.
constexpr bool worth_another_level(size_t removed, size_t left) {
  constexpr size_t kMinProgress = 200;
  return removed >= std::max<size_t>(1, left / kMinProgress);
}

}  // namespace reeb
