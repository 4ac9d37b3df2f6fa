#include "codec/enc/effort.h"

#include "codec/enc/encoder.h"

namespace reeb {

namespace {

constexpr double kUsual = 0.0095;  ///< tolerance of a target

constexpr EffortPreset kPresets[kMostEffort] = {
    {0.0, 0, 4, false, kUsual, false}, {0.0, 0, 5, true, kUsual, false},
    {0.3, 1, 6, true, kUsual, false},  {0.5, 1, 7, true, kUsual, false},
    {0.5, 2, 7, true, kUsual, false},  {0.5, 2, 7, true, 0.0065, false},
    {0.5, 2, 8, true, 0.0045, false},  {0.5, 3, 8, true, 0.003, false},
    {0.5, 4, 8, true, 0.001, true},
};

}  // namespace

const EffortPreset& effort_preset(int effort) { return kPresets[effort - kLeastEffort]; }

}  // namespace reeb
