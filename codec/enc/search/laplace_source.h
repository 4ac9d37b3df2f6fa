// Rate and distortion of a uniformly quantized Laplace source, in closed form.
#pragma once

namespace reeb {

struct RatePoint {
  double bits = 0;        ///< entropy of a sample
  double distortion = 0;  ///< mean squared error of a sample
};

/// Source of mean absolute value `scale` > 0, quantized to the nearest multiple of `step` > 0, but
/// to 0 up to `threshold` (0.5 <= threshold < 1.5) steps.
RatePoint quantized_laplace_source(double scale, double step, double threshold = 0.5);

/// Step that minimises distortion + slope * bits; the largest one tried where nothing is worth
/// sending.
double laplace_source_step(double scale, double slope);

}  // namespace reeb
