#include "codec/enc/effort.h"

#include "codec/enc/encoder.h"

namespace reeb {

namespace {

constexpr EffortPreset kPresets[kMostEffort] = {
    {0.0, 0, 4, 0, false}, {0.1, 1, 5, 0, false}, {0.2, 1, 6, 0, false},
    {0.3, 1, 7, 0, false}, {0.5, 2, 7, 0, false}, {0.5, 3, 7, 0, false},
    {0.5, 4, 8, 0, false}, {0.5, 4, 8, 2, false}, {0.5, 6, 8, 4, true},
};

}  // namespace

const EffortPreset& effort_preset(int effort) { return kPresets[effort - kLeastEffort]; }

}  // namespace reeb
