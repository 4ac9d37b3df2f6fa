#include "codec/enc/search/laplace_source.h"

#include <algorithm>
#include <cmath>

namespace reeb {

namespace {
double bits_of(double p) { return p > 0 ? -p * std::log2(p) : 0; }
}  // namespace

RatePoint quantized_laplace_source(double scale, double step, double threshold) {
  // Density exp(-|x| / b) / 2b. Magnitude 1 covers (threshold, 3/2) steps, magnitude n > 1 covers
  // (n - 1/2, n + 1/2) with probability p2 r^(n - 2) a side.
  const double b = std::max(scale, 1e-300);
  const double zone = threshold * step;
  const double outside = std::exp(-zone / b);       // P(|x| > zone)
  const double beyond = std::exp(-1.5 * step / b);  // P(|x| > 3/2 steps)
  const double r = std::exp(-step / b);
  RatePoint out;
  out.bits = bits_of(1 - outside) + 2 * bits_of((outside - beyond) / 2);
  const double p2 = beyond * (1 - r) / 2;
  if (p2 > 0) {
    const double log_ratio = step / b / std::log(2.0);  // -log2 r
    out.bits += beyond * -std::log2(p2) + beyond * r / (1 - r) * log_ratio;
  }
  // Integral of (x - c)^2 exp(-x / b) / b from y on.
  const auto error_from = [b](double y, double c) {
    return std::exp(-y / b) * ((y - c) * (y - c) + 2 * b * (y - c) + 2 * b * b);
  };
  const double inner = 2 * b * b - error_from(zone, 0);
  const double first = error_from(zone, step) - error_from(1.5 * step, step);
  // All further magnitudes are alike: x from half a step below to half a step above.
  const double further = error_from(0, step / 2) - error_from(step, step / 2);
  out.distortion = inner + first + (r < 1 ? beyond * further / (1 - r) : 0);
  return out;
}

double laplace_source_step(double scale, double slope) {
  const double middle = std::sqrt(6 * slope / std::log(2.0));  // best at high rate
  double best = middle;
  double best_cost = 1e300;
  for (int i = -20; i <= 40; ++i) {  // a sixteenth of an octave apart
    const double step = middle * std::exp2(i / 16.0);
    const RatePoint point = quantized_laplace_source(scale, step);
    const double cost = point.distortion + slope * point.bits;
    if (cost < best_cost) {
      best_cost = cost;
      best = step;
    }
  }
  return best;
}

}  // namespace reeb
