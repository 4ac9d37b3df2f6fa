#include "codec/enc/laplacian.h"

#include <algorithm>
#include <cmath>

namespace reeb {

namespace {
double bits_of(double p) { return p > 0 ? -p * std::log2(p) : 0; }
}  // namespace

RatePoint quantized_laplacian(double scale, double step) {
  // Density exp(-|x| / b) / 2b. Level n >= 1 covers (n - 1/2, n + 1/2) steps with probability p1
  // r^(n - 1) a side.
  const double b = std::max(scale, 1e-300);
  const double r = std::exp(-step / b);
  const double outside = std::exp(-step / (2 * b));  // P(|x| > step / 2)
  const double p1 = outside * (1 - r) / 2;
  RatePoint out;
  out.bits = bits_of(1 - outside);
  if (p1 > 0) {
    const double log_ratio = step / b / std::log(2.0);  // -log2 r
    out.bits += outside * -std::log2(p1) + outside * r / (1 - r) * log_ratio;
  }
  // E[x^2] = 2 b^2 less what the levels take away: sum over n of 2 n step E[x; level n] - (n
  // step)^2 P(level n).
  const double half = step / 2;
  const double inner =
      2 * b * b - outside * (half * half + 2 * b * half + 2 * b * b);  // of the zero level
  const double u = step / b;
  // Within a level, y = x - (n - 1/2) step is exponential, cut at one step; its error is y - step
  // / 2.
  const double cut = 1 - r;
  const double mean = b - step * r / std::max(cut, 1e-300);
  const double square = cut > 0 ? 2 * b * b - r * step * step * (1 + 2 / u) / cut : 0;
  out.distortion = inner + outside * (square - step * mean + half * half);
  return out;
}

double laplacian_step(double scale, double slope) {
  const double middle = std::sqrt(6 * slope / std::log(2.0));  // best at high rate
  double best = middle;
  double best_cost = 1e300;
  for (int i = -20; i <= 40; ++i) {  // a sixteenth of an octave apart
    const double step = middle * std::exp2(i / 16.0);
    const RatePoint point = quantized_laplacian(scale, step);
    const double cost = point.distortion + slope * point.bits;
    if (cost < best_cost) {
      best_cost = cost;
      best = step;
    }
  }
  return best;
}

}  // namespace reeb
