// generate_streams FOLDER: writes FOLDER/CLASS/NAME.reeb and, to standard output, a line a stream:
// class, name, status and sentence, separated by tabs. conformance/generate.py does the rest.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "conformance/generate/stream.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: generate_streams FOLDER\n", stderr);
    return 2;
  }
  using reeb::conformance::Stream;
  std::vector<Stream> streams = reeb::conformance::encoded_streams();
  for (Stream& s : reeb::conformance::pinning_streams()) streams.push_back(std::move(s));
  for (Stream& s : reeb::conformance::attribute_streams()) streams.push_back(std::move(s));
  for (Stream& s : reeb::conformance::built_streams()) streams.push_back(std::move(s));
  for (const Stream& s : streams) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / s.kind;
    std::filesystem::create_directories(folder);
    std::ofstream out(folder / (s.name + ".reeb"), std::ios::binary);
    out.write(reinterpret_cast<const char*>(s.bytes.data()), static_cast<long>(s.bytes.size()));
    if (!out) return 1;
    std::printf("%s\t%s\t%s\t%s\n", s.kind.c_str(), s.name.c_str(), s.status.c_str(),
                s.sentence.c_str());
  }
  return 0;
}
