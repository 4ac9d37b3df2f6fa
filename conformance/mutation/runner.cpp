// Decodes streams with one mutant on, all in one process: see mutate.py.
//   runner baseline STREAM...           prints of each stream: hash, CPU microseconds, whether all
//   of it decodes,
//                                       sites that ran
//   runner try MUTANT LIST              LIST has lines of stream, hash, microseconds; prints the
//   first
//                                       stream that decodes otherwise, and ends with 1
#include <sys/resource.h>
#include <sys/time.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"

namespace mutants {

unsigned char hits[1 << 16];
int chosen = -1;

namespace {

/// Made before anything else, so that tables feel the mutant, too.
struct Choice {
  Choice() {
    const char* name = std::getenv("REEB_MUTANT");
    if (name != nullptr) chosen = std::atoi(name);
  }
};
__attribute__((init_priority(101))) const Choice kChoice;

}  // namespace

}  // namespace mutants

namespace {

using Bytes = std::vector<uint8_t>;

class Hash {
 public:
  void add(const void* data, size_t size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001B3u;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    const uint64_t count = values.size();
    add(&count, sizeof count);
    add(values.data(), values.size() * sizeof(T));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xCBF29CE484222325u;
};

void add_status(Hash& hash, const reeb::Status& status) {
  const int code = static_cast<int>(status.code());
  hash.add(&code, sizeof code);
}

bool add_frame(Hash& hash, reeb::Decoder& decoder, uint32_t t, const reeb::Connectivity*& last) {
  const reeb::Connectivity* mesh = nullptr;
  reeb::Status s = decoder.connectivity(t, mesh);
  std::vector<float> xyz;
  if (s.ok()) {
    xyz.resize(size_t{mesh->vertex_count} * 3);
    s = decoder.decode_frame(t, xyz.data());
  }
  add_status(hash, s);
  if (!s.ok()) return false;
  if (mesh != last) {
    hash.add(&mesh->vertex_count, sizeof mesh->vertex_count);
    hash.add(mesh->face_sizes);
    hash.add(mesh->corners);
    last = mesh;
  }
  hash.add(xyz);
  return true;
}

/// The hash of all that conformance compares; `whole` tells whether every frame decoded.
uint64_t decode(const Bytes& bytes, bool& whole) {
  Hash hash;
  reeb::DecodeOptions options;
  options.threads = 1;
  std::unique_ptr<reeb::Decoder> decoder;
  const reeb::Status opened = reeb::Decoder::open({bytes.data(), bytes.size()}, options, decoder);
  add_status(hash, opened);
  whole = opened.ok();
  if (!opened.ok()) return hash.value();
  const reeb::StreamInfo& info = decoder->info();
  hash.add(&info.total_frames, sizeof info.total_frames);
  hash.add(&info.truncated, sizeof info.truncated);
  const reeb::Connectivity* last = nullptr;
  whole = !info.truncated;
  for (uint32_t t = 0; t < info.total_frames; ++t)
    if (!add_frame(hash, *decoder, t, last)) whole = false;
  return hash.value();
}

Bytes read(const char* name) {
  std::ifstream in(name, std::ios::binary);
  return Bytes((std::istreambuf_iterator<char>(in)), {});
}

int64_t cpu_microseconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return int64_t{t.tv_sec} * 1000000 + t.tv_nsec / 1000;
}

/// The process ends by a signal after that much processor time.
void allow(int64_t microseconds) {
  itimerval limit{};
  limit.it_value.tv_sec = microseconds / 1000000;
  limit.it_value.tv_usec = microseconds % 1000000;
  setitimer(ITIMER_PROF, &limit, nullptr);
}

int baseline(int count, char** names) {
  for (int i = 0; i < count; ++i) {
    std::memset(mutants::hits, 0, sizeof mutants::hits);
    const int64_t start = cpu_microseconds();
    bool whole = false;
    const uint64_t hash = decode(read(names[i]), whole);
    std::printf("%s\t%llu\t%lld\t%d\t", names[i], static_cast<unsigned long long>(hash),
                static_cast<long long>(cpu_microseconds() - start), whole ? 1 : 0);
    for (size_t s = 0; s < sizeof mutants::hits; ++s)
      if (mutants::hits[s] != 0) std::printf(" %zu", s);
    std::printf("\n");
  }
  return 0;
}

int try_mutant(int number, const char* list) {
  rlimit memory{rlim_t{3} << 30, rlim_t{3} << 30};
  setrlimit(RLIMIT_AS, &memory);
  mutants::chosen = number;
  std::ifstream in(list);
  std::string name;
  uint64_t hash;
  int64_t microseconds;
  while (in >> name >> hash >> microseconds) {
    const Bytes bytes = read(name.c_str());
    std::printf("%s\n", name.c_str());
    std::fflush(stdout);
    allow(8 * microseconds + 200000);
    bool whole = false;
    if (decode(bytes, whole) != hash) return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 && std::strcmp(argv[1], "baseline") == 0) return baseline(argc - 2, argv + 2);
  if (argc == 4 && std::strcmp(argv[1], "try") == 0) return try_mutant(std::atoi(argv[2]), argv[3]);
  return 2;
}
