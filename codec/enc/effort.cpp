#include "codec/enc/effort.h"

#include "codec/enc/encoder.h"

namespace reeb {

namespace {

constexpr EffortPreset kPresets[kMostEffort] = {
    {0.0, 0, 4, 0, false, false}, {0.0, 0, 5, 0, true, false}, {0.3, 1, 6, 0, true, false},
    {0.5, 1, 7, 0, true, false},  {0.5, 2, 7, 0, true, false}, {0.5, 2, 7, 2, true, false},
    {0.5, 3, 8, 4, true, false},  {0.5, 3, 8, 8, true, false}, {0.5, 4, 8, 12, true, true},
};

}  // namespace

const EffortPreset& effort_preset(int effort) { return kPresets[effort - kLeastEffort]; }

}  // namespace reeb
