// Splits streams into first inputs for the fuzzers: fuzz_seeds FOLDER STREAM...
// writes FOLDER/{connectivity,container,decode,group,push,reference}/.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "bitstream/container.h"
#include "bitstream/syntax.h"

namespace {

void write(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
}

/// As group_fuzz takes it; counts of the header are the fuzzer's own.
std::vector<uint8_t> group_input(const reeb::GroupChunk& group) {
  const bool moving = group.header.region_count > 0;
  const bool corrected = group.header.correction_count > 0;
  const bool quick = group.header.profile == reeb::Profile::kLossless &&
                     (group.header.flags & reeb::GroupHeader::kQuick) != 0;
  std::vector<uint8_t> out = {static_cast<uint8_t>(static_cast<uint8_t>(group.header.profile) +
                                                   (moving ? 64 : 0) + (corrected ? 128 : 0) +
                                                   (quick ? 32 : 0))};
  for (const auto& section : {group.motion, group.coefficients, group.basis}) {
    out.push_back(static_cast<uint8_t>(section.size()));
    out.push_back(static_cast<uint8_t>(section.size() >> 8));
  }
  for (const auto& section : {group.motion, group.coefficients, group.basis, group.corrections})
    out.insert(out.end(), section.begin(), section.end());
  return out;
}

std::span<const uint8_t> connectivity_in(const reeb::ReferenceChunk& reference) {
  reeb::ByteReader in(reference.mesh);
  reeb::MeshHeader h;
  return reeb::read_header(in, "mesh header", h).ok() ? in.take(h.draco_bytes)
                                                      : std::span<const uint8_t>{};
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
    write(folder / "work" / name, file);
    for (const reeb::ReferenceChunk& r : reader.references) {
      write(folder / "reference" / (name + std::to_string(r.header.shot)), r.mesh);
      write(folder / "connectivity" / (name + std::to_string(r.header.shot)), connectivity_in(r));
    }
    std::vector<uint8_t> pushed = {7};
    pushed.insert(pushed.end(), file.begin(), file.end());
    write(folder / "push" / name, pushed);
    for (size_t g = 0; g < reader.groups.size(); ++g)
      write(folder / "group" / (name + std::to_string(g)), group_input(reader.groups[g]));
  }
  return 0;
}
