// The ways in which a group may be coded.
#pragma once

#include <cstdint>

namespace reeb {

enum class Profile : uint8_t {
  kMain = 0,      ///< prediction weights learned while decoding
  kFast = 1,      ///< quick to decode: weights learned from the reference and the first components
  kThesis = 2,    ///< no temporal transform: residual of the affine motion per frame and coordinate
  kLossless = 3,  ///< every bit of every position: frames one after another
};

}  // namespace reeb
