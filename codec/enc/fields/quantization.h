// What the encoders of fields decide by, and how far they are off.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// The prediction mass of every row to a power: what its errors weigh.
inline std::vector<double> row_importance(const PredictionGraph& graph, double exponent) {
  std::vector<double> out;
  out.reserve(graph.size());
  for (const uint8_t index : graph.step_index) out.push_back(std::exp2(exponent * index / 8.0));
  return out;
}

/// The magnitude n that minimises importance * error^2 + lambda * bits(n), of the nearest one, the
/// one below and 0. `size`: the residual's magnitude in steps; `step` in q.
template <class Bits>
uint32_t cheapest_magnitude(double size, uint32_t nearest, double step, double importance,
                            double lambda, Bits&& bits) {
  uint32_t best = nearest;
  double least = std::numeric_limits<double>::max();
  const auto consider = [&](uint32_t n) {
    const double error = (size - n) * step;
    const double cost = error * error * importance + lambda * bits(n);
    if (cost < least) {
      least = cost;
      best = n;
    }
  };
  consider(nearest);
  if (nearest > 0) consider(nearest - 1);
  if (nearest > 1) consider(0);
  return best;
}

/// Sum of squares of plane[row] - target[row].
inline double squared_error(const std::vector<float>& plane, const float* target) {
  double sum = 0;
  for (size_t row = 0; row < plane.size(); ++row) {
    const double d = static_cast<double>(plane[row]) - static_cast<double>(target[row]);
    sum += d * d;
  }
  return sum;
}

}  // namespace reeb
