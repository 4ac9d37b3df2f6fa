// What makes a mesh coarse alike, with its positions (collapse.h) and without (contraction.h):
// in sweeps, vertices that are not next to each other are removed, until little is left or goes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace reeb {

inline constexpr uint32_t kBaseSize = 64;   ///< vertices that are left
inline constexpr uint32_t kMaxValence = 9;  ///< of a removed vertex

/// False where a sweep has removed fewer than one in 200 of the vertices that it has left.
constexpr bool worth_another_sweep(size_t removed, size_t left) {
  constexpr size_t kMinProgress = 200;
  return removed >= std::max<size_t>(1, left / kMinProgress);
}

}  // namespace reeb
