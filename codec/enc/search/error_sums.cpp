#include "codec/enc/search/error_sums.h"

#include <algorithm>
#include <cmath>

namespace reeb {

void ErrorSums::add(std::span<const float> original, std::span<const float> decoded) {
  for (size_t v = 0; v + 3 <= original.size(); v += 3) {
    double square = 0;
    for (size_t i = v; i < v + 3; ++i) {
      const double d = static_cast<double>(decoded[i]) - static_cast<double>(original[i]);
      square += d * d;
      largest = std::max(largest, std::abs(d));
    }
    squared += square;
  }
}

void ErrorSums::add(const ErrorSums& other) {
  squared += other.squared;
  largest = std::max(largest, other.largest);
}

}  // namespace reeb
