// Finds the decimals that coordinates were written with.
#pragma once

#include "codec/common/exact_frames.h"
#include "codec/common/number_set.h"

namespace reeb {

/// The set that codes one axis of the frames best: decimals where nearly all values are, and are
/// sparser than binary32; else every binary32 value.
NumberSet choose_number_set(const ExactFrames& frames, uint32_t axis);

}  // namespace reeb
