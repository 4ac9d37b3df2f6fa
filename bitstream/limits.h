// What a caller allows a stream to ask for.
#pragma once

#include <cstdint>

namespace reeb {

struct Limits {
  uint32_t max_vertices = 1u << 24;  ///< per shot
  uint32_t max_faces = 1u << 25;     ///< per shot
  uint32_t max_frames = 1u << 20;    ///< of the sequence
  uint64_t max_memory = 4ull << 30;  ///< bytes the decoder may hold at once
};

}  // namespace reeb
