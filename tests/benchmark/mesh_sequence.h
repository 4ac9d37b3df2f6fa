// Reader of the benchmark's input: a Wavefront OBJ for the triangles and a Point Cache 2 file for
// the frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb::benchmark {

struct MeshSequence {
  std::string name;                 ///< file name of the OBJ without folder and extension
  std::vector<uint32_t> triangles;  ///< three vertices each
  std::vector<float> frames;        ///< [frame][vertex][x, y, z]
  uint32_t vertex_count = 0;
  uint32_t frame_count = 0;

  std::span<const float> frame(uint32_t t) const {
    const size_t size = 3 * static_cast<size_t>(vertex_count);
    return {frames.data() + t * size, size};
  }
};

/// Reads NAME.obj and, beside it, NAME.pc2. False when a file is missing or not what it should be.
bool read_sequence(const std::string& obj_path, MeshSequence& sequence);

}  // namespace reeb::benchmark
