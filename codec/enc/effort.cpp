#include "codec/enc/effort.h"

#include "codec/enc/encoder.h"

namespace reeb {

namespace {

constexpr EffortPreset kPresets[kMostEffort] = {
    {0.0, 0, 4, 0, kMetTolerance, false, false}, {0.0, 0, 5, 0, kMetTolerance, true, false},
    {0.2, 1, 6, 0, kMetTolerance, true, false},  {0.5, 1, 6, 0, kMetTolerance, true, false},
    {0.5, 2, 7, 0, kMetTolerance, true, false},  {0.5, 2, 7, 1, 0.005, true, false},
    {0.5, 2, 8, 3, 0.004, true, false},          {0.5, 3, 8, 8, 0.003, true, false},
    {0.5, 3, 8, 16, 0.003, true, true},
};

}  // namespace

const EffortPreset& effort_preset(int effort) { return kPresets[effort - kLeastEffort]; }

}  // namespace reeb
