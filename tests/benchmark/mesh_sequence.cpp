#include "tests/benchmark/mesh_sequence.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace reeb::benchmark {
namespace {

// Faces of more than three corners become fans; texture and normal indices are skipped.
bool read_triangles(const std::string& path, std::vector<uint32_t>& triangles) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != "f") continue;
    std::vector<uint32_t> corners;
    while (words >> word) corners.push_back(static_cast<uint32_t>(std::stoul(word)) - 1);
    for (size_t i = 2; i < corners.size(); ++i) {
      triangles.insert(triangles.end(), {corners[0], corners[i - 1], corners[i]});
    }
  }
  return !triangles.empty();
}

bool read_frames(const std::string& path, MeshSequence& sequence) {
  std::ifstream file(path, std::ios::binary);
  char header[32];
  if (!file.read(header, sizeof header) || std::memcmp(header, "POINTCACHE2", 12) != 0)
    return false;
  std::memcpy(&sequence.vertex_count, header + 16, 4);
  std::memcpy(&sequence.frame_count, header + 28, 4);
  const size_t size = 3 * static_cast<size_t>(sequence.vertex_count) * sequence.frame_count;
  if (std::filesystem::file_size(path) < sizeof header + 4 * size) return false;
  sequence.frames.resize(size);
  return !!file.read(reinterpret_cast<char*>(sequence.frames.data()),
                     static_cast<std::streamsize>(4 * size));
}

}  // namespace

bool read_sequence(const std::string& obj_path, MeshSequence& sequence) {
  std::filesystem::path path(obj_path);
  sequence.name = path.stem().string();
  if (!read_triangles(path.string(), sequence.triangles)) return false;
  return read_frames(path.replace_extension(".pc2").string(), sequence) &&
         std::all_of(sequence.triangles.begin(), sequence.triangles.end(),
                     [&](uint32_t v) { return v < sequence.vertex_count; });
}

}  // namespace reeb::benchmark
