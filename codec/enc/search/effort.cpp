#include "codec/enc/search/effort.h"

#include "codec/enc/encoder.h"

namespace reeb {

namespace {

constexpr EffortPreset kPresets[kMaxEffort] = {
    {0.0, kMetTolerance, 0, 4, 0, false, false}, {0.0, kMetTolerance, 0, 5, 0, true, false},
    {0.2, kMetTolerance, 1, 6, 0, true, false},  {0.5, kMetTolerance, 1, 6, 0, true, false},
    {0.5, kMetTolerance, 2, 7, 0, true, false},  {0.5, 0.005, 2, 7, 1, true, false},
    {0.5, 0.004, 2, 8, 3, true, false},          {0.5, 0.003, 3, 8, 8, true, false},
    {0.5, 0.003, 3, 8, 16, true, true},
};

}  // namespace

const EffortPreset& effort_preset(int effort) { return kPresets[effort - kMinEffort]; }

}  // namespace reeb
