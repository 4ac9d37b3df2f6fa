// How fast OBJ sequences are read: bytes alone, our reader, and two plain line-by-line readers.
//
// read_benchmark [FOLDER]: a folder of OBJ frames; without it, 100 frames of the sample "creature"
// are written to a temporary folder first. Best of three rounds each, files in the page cache.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tools/io/file_bytes.h"
#include "tools/io/frame_list.h"
#include "tools/io/read_sequence.h"
#include "tools/io/write_sequence.h"
#include "tools/sample/sample.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> corners;
};

void read_by_streams(const fs::path& path, Mesh& mesh) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "v") {
      for (float x = 0; words >> x;) mesh.positions.push_back(x);
    } else if (keyword == "f") {
      for (std::string corner; words >> corner;) {
        mesh.corners.push_back(static_cast<uint32_t>(std::stoul(corner)) - 1);
      }
    }
  }
}

void read_by_strtof(const fs::path& path, Mesh& mesh) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const bool vertex = line.rfind("v ", 0) == 0;
    if (!vertex && line.rfind("f ", 0) != 0) continue;
    char* at = line.data() + 2;
    for (int i = 0; i < 3; ++i) {
      if (vertex) {
        mesh.positions.push_back(std::strtof(at, &at));
      } else {
        mesh.corners.push_back(static_cast<uint32_t>(std::strtoul(at, &at, 10)) - 1);
      }
    }
  }
}

double best_seconds(const std::function<void()>& work) {
  double best = 1e9;
  for (int round = 0; round < 3; ++round) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count());
  }
  return best;
}

bool read_ours(const std::string& folder, unsigned threads) {
  Sequence sequence;
  ReadReport report;
  return read_sequence({folder}, {.threads = threads}, sequence, report).ok();
}

int run(const std::string& folder) {
  InputFiles input;
  if (const Status status = find_input({folder}, true, input); !status.ok()) {
    std::fprintf(stderr, "%s\n", status.message().c_str());
    return 1;
  }
  double bytes = 0;
  for (const fs::path& file : input.meshes) bytes += static_cast<double>(fs::file_size(file));
  bool good = true;
  const auto each = [&](auto reader) {
    return [&input, reader] {
      for (const fs::path& file : input.meshes) {
        Mesh mesh;
        reader(file, mesh);
      }
    };
  };
  const auto show = [&](const char* name, const std::function<void()>& work) {
    const double seconds = best_seconds(work);
    std::printf("%-28s %8.3f s %8.0f MB/s\n", name, seconds, bytes / 1e6 / seconds);
  };
  std::printf("%zu files, %.1f MB\n", input.meshes.size(), bytes / 1e6);
  show("bytes alone", each([&](const fs::path& file, Mesh&) {
         FileBytes content;
         good = FileBytes::read(file, content).ok() && good;
       }));
  show("reeb, 1 thread", [&] { good = read_ours(folder, 1) && good; });
  show("reeb, all cores", [&] { good = read_ours(folder, 0) && good; });
  show("getline and strtof", each(read_by_strtof));
  show("getline and istringstream", each(read_by_streams));
  return good ? 0 : 1;
}

}  // namespace
}  // namespace reeb::tools

int main(int argc, char** argv) {
  using namespace reeb::tools;
  if (argc > 1) return run(argv[1]);
  const fs::path folder = fs::temp_directory_path() / "reeb_read_benchmark";
  reeb::Sequence sequence;
  if (!make_sample("creature", 100, sequence).ok()) return 1;
  const bool written =
      write_sequence(source_of(sequence), folder / "f_%04d.obj", {.overwrite = true}).ok();
  const int exit_code = written ? run(folder) : 1;
  fs::remove_all(folder);
  return exit_code;
}
