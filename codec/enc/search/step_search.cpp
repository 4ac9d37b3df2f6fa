#include "codec/enc/search/step_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb {

namespace {

constexpr double kErrorSlope = 0.9;  ///< d ln(error) / d ln(q), typically
constexpr double kSizeSlope = -0.7;
constexpr double kLongSecant = 0.2;  ///< in ln q
constexpr double kMaxChange = 2.0;   ///< in ln q

/// Trials so far, as a function of ln q; `sign` makes it an increasing one.
class Bracket {
 public:
  Bracket(const StepSearchOptions& options, double aim)
      : sign_(options.grows ? 1 : -1), slope_(options.slope), aim_(aim) {
    if (slope_ <= 0) slope_ = options.grows ? kErrorSlope : -kSizeSlope;
  }

  void add(double x, double excess) {
    const double y = sign_ * (excess - aim_);
    if (have_last_ && std::abs(x - last_x_) > 1e-9) {
      // Over a short step the secant is mostly noise: components come and go.
      const double trust = std::min(1.0, std::abs(x - last_x_) / kLongSecant);
      const double secant = (y - last_y_) / (x - last_x_);
      slope_ = std::clamp(slope_ + trust * (secant - slope_), 0.15, 4.0);
    }
    last_x_ = x;
    last_y_ = y;
    have_last_ = true;
    (y < 0 ? low_ : high_) = y < 0 ? std::max(low_, x) : std::min(high_, x);
  }

  double next() const {
    const double step = std::clamp(-last_y_ / slope_, -kMaxChange, kMaxChange);
    const double x = last_x_ + step;
    const bool bracketed = std::isfinite(low_) && std::isfinite(high_);
    if (bracketed && (x <= low_ || x >= high_)) return 0.5 * (low_ + high_);
    return x;
  }

  bool exhausted() const { return high_ - low_ < 1e-4; }

 private:
  double sign_;
  double slope_;
  double aim_;
  double low_ = -std::numeric_limits<double>::infinity();
  double high_ = std::numeric_limits<double>::infinity();
  double last_x_ = 0;
  double last_y_ = 0;
  bool have_last_ = false;
};

bool better(const StepTrial& a, const StepTrial& b) {
  if ((a.excess <= 0) != (b.excess <= 0)) return a.excess <= 0;
  return std::abs(a.excess) < std::abs(b.excess);
}

}  // namespace

StepTrial search_step(const StepTrial& first, const StepSearchOptions& options,
                      const std::function<double(double)>& measure) {
  Bracket bracket(options, -options.tolerance / 2);
  StepTrial best = first;
  StepTrial trial = first;
  const double lowest = std::log(std::max(options.least_q, 1e-300));
  for (int i = 0; i < options.max_trials; ++i) {
    if (trial.excess <= 0 && trial.excess >= -options.tolerance) break;
    const double x = std::log(trial.q);
    bracket.add(x, trial.excess);
    const double next = std::max(bracket.next(), lowest);
    if (bracket.exhausted() || next == x) break;
    trial = {std::exp(next), measure(std::exp(next))};
    if (better(trial, best)) best = trial;
  }
  return best;
}

double search_least(double q0, double ratio, int max_trials,
                    const std::function<double(double)>& cost) {
  struct Point {
    double x, y;
  };
  const double stride = std::log(ratio);
  const auto at = [&](double x) { return Point{x, cost(std::exp(x))}; };
  Point best = at(std::log(q0));
  Point left = at(best.x - stride);
  int trials = 2;
  const double direction = left.y < best.y ? -1 : 1;
  Point behind = left;
  if (direction < 0) {
    behind = best;
    best = left;
  }
  for (; trials < max_trials; ++trials) {
    const Point ahead = at(best.x + direction * stride);
    if (ahead.y < best.y) {
      behind = best;
      best = ahead;
      continue;
    }
    // The minimum lies between; a parabola through the three says where.
    const double bend = behind.y - 2 * best.y + ahead.y;
    const double shift = bend > 0 ? direction * stride * 0.5 * (behind.y - ahead.y) / bend : 0;
    if (++trials < max_trials && std::abs(shift) > 0.15 * stride) {
      const Point last = at(best.x + shift);
      if (last.y < best.y) best = last;
    }
    break;
  }
  return std::exp(best.x);
}

}  // namespace reeb
