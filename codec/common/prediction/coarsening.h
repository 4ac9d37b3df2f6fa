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

/// Keeps all sweeps together linear in the mesh: hostile meshes lose few vertices in each.
class TryBudget {
 public:
  explicit TryBudget(size_t vertices) : left_(kTriesPerVertex * vertices) {}

  /// For a sweep that tries so many vertices; false where that is more than there is left.
  constexpr bool take(size_t tried) {
    if (tried > left_) return false;
    left_ -= tried;
    return true;
  }

 private:
  static constexpr size_t kTriesPerVertex = 32;  ///< real meshes take six
  size_t left_;
};

}  // namespace reeb
