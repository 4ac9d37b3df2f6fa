// Splits streams into first inputs for the fuzzers: fuzz_seeds FOLDER STREAM...
// writes FOLDER/{container,decode,group,reference}/.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "bitstream/container.h"

namespace {

void write(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::filesystem::path folder = argv[1];
  for (int i = 2; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const std::vector<uint8_t> file(std::istreambuf_iterator<char>(in), {});
    const std::string name = std::filesystem::path(argv[i]).stem().string();
    reeb::ContainerReader reader;
    if (!reader.parse(file, {}).ok()) return 1;
    write(folder / "container" / name, file);
    write(folder / "decode" / name, file);
    for (const reeb::ReferenceChunk& r : reader.references)
      write(folder / "reference" / (name + std::to_string(r.header.shot)), r.mesh);
    for (size_t g = 0; g < reader.groups.size(); ++g) {
      reeb::Chunk chunk;
      if (reeb::read_chunk(file, reader.groups[g].offset, chunk) != reeb::ChunkResult::kFound)
        return 1;
      write(folder / "group" / (name + std::to_string(g)), chunk.payload);
    }
  }
  return 0;
}
