// What each effort spends time on.
#pragma once

#include <cstdint>

namespace reeb {

/// What counts as a target met, relative to it.
inline constexpr double kMetTolerance = 0.0095;

struct EffortPreset {
  /// Half the width of the zone between two reference grids in which the estimate does not decide,
  /// but a trial, in bits: 0 .. 0.5.
  double grid_doubt;
  double tolerance;       ///< of the error or size asked for, by which the last step may fall short
  int grid_trials;        ///< at most
  int base_trials;        ///< steps tried under the corrections of a bounded error
  int polish_trials;      ///< steps tried beside the last one
  bool weak_prior_trial;  ///< a weak prior of the weights is tried
  bool region_trials;     ///< the motion model is tried in the main profile too
};

/// `effort`: kMinEffort .. kMaxEffort.
const EffortPreset& effort_preset(int effort);

}  // namespace reeb
