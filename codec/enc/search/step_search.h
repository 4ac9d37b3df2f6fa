// Search for the quantization step that meets a target.
#pragma once

#include <functional>
#include <vector>

namespace reeb {

/// What a trial gave, against the target.
struct StepTrial {
  double q = 0;
  /// ln(measured / wanted): above 0 the target is missed.
  double excess = 0;
};

struct StepSearchOptions {
  bool grows = true;         ///< the measure grows with q (an error) or falls (a size)
  double tolerance = 0.008;  ///< a trial within [-tolerance, 0] of the target ends the search
  int max_trials = 12;
  double least_q = 0;  ///< finer steps are not tried
  double slope = 0;    ///< expected |d excess / d ln q|; 0 = what is usual
};

/// Runs `measure(q)` (which returns the excess) by secants within a bracket; `first` is a trial
/// already made. Returns the trial nearest below the target, or the one nearest above where none is
/// below.
StepTrial search_step(const StepTrial& first, const StepSearchOptions& options,
                      const std::function<double(double)>& measure);

/// Looks for the q of the least `cost(q)`, taken to have one minimum, from `q0` on, by steps of a
/// factor `ratio` (> 1) until the minimum is bracketed, then once in between. Returns the best q
/// tried.
double search_least(double q0, double ratio, int max_trials,
                    const std::function<double(double)>& cost);

}  // namespace reeb
