// Sums of errors over frames.
#pragma once

#include <span>

namespace reeb {

struct ErrorSums {
  double squared = 0;  ///< of the distances of the vertices from where the input has them
  double largest = 0;  ///< of a coordinate

  /// Adds a frame, xyz of every vertex.
  void add(std::span<const float> original, std::span<const float> decoded);
  void add(const ErrorSums& other);
};

}  // namespace reeb
