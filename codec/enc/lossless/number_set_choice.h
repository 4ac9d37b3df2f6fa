// Finds the decimals that coordinates were written with.
#pragma once

#include "codec/common/lossless/number_set.h"
#include "codec/common/synthesis/exact_frames.h"

namespace reeb {

/// The set that codes one axis of the frames best: decimals where nearly all values are, and are
/// sparser than binary32; else every binary32 value.
NumberSet choose_number_set(const ExactFrames& frames, uint32_t axis);

}  // namespace reeb
