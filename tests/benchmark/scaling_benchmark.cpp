// How decoding a whole sequence gains from threads, which share its groups.
//
// scaling_benchmark THREADS ROUNDS INPUT...: INPUT is one sequence as `reeb encode` takes it. Coded
// at the default error in 12 groups, in both profiles, and decoded with 1 .. THREADS threads: one
// line of CSV each, from the least wall time of ROUNDS rounds in which the numbers of threads take
// turns; with the reference mesh, which comes before all groups, and for the groups alone. Wants a
// machine with nothing else to do.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"
#include "tools/io/read_sequence.h"

namespace {

constexpr uint32_t kGroups = 12;

void check(const reeb::Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "scaling_benchmark: %s\n", status.message().c_str());
  std::exit(1);
}

double time_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  return took.count();
}

void decode(const std::vector<uint8_t>& bytes, unsigned threads) {
  reeb::DecodeOptions options;
  options.threads = threads;
  reeb::Sequence decoded;
  check(reeb::decode_sequence(bytes, options, decoded));
}

void decode_mesh(const std::vector<uint8_t>& bytes) {
  std::unique_ptr<reeb::Decoder> decoder;
  const reeb::Connectivity* connectivity = nullptr;
  check(reeb::Decoder::open(bytes, {}, decoder));
  check(decoder->connectivity(0, connectivity));
}

void measure(const char* name, const reeb::Sequence& sequence, reeb::Profile profile,
             unsigned most_threads, int rounds) {
  reeb::EncodeOptions options;
  options.profile = profile;
  options.group_length = (sequence.frame_count() + kGroups - 1) / kGroups;
  std::vector<uint8_t> bytes;
  reeb::EncodeStats stats;
  check(reeb::encode(sequence, options, bytes, stats));
  std::vector<double> least(most_threads + 1, 1e9);  // [0]: the mesh alone
  for (int round = 0; round < rounds; ++round) {
    least[0] = std::min(least[0], time_of([&] { decode_mesh(bytes); }));
    for (unsigned t = 1; t <= most_threads; ++t)
      least[t] = std::min(least[t], time_of([&] { decode(bytes, t); }));
  }
  const double vertices = 8 * static_cast<double>(bytes.size()) / stats.bpvf;
  for (unsigned t = 1; t <= most_threads; ++t) {
    std::printf("%s,%s,%u,%.2f,%.2f,%.2f\n", name,
                profile == reeb::Profile::kMain ? "main" : "fast", t, 1e-6 * vertices / least[t],
                least[1] / least[t], (least[1] - least[0]) / (least[t] - least[0]));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int threads = argc > 3 ? std::atoi(argv[1]) : 0, rounds = argc > 3 ? std::atoi(argv[2]) : 0;
  if (threads < 1 || rounds < 1) {
    std::fputs("usage: scaling_benchmark THREADS ROUNDS INPUT...\n", stderr);
    return 2;
  }
  reeb::Sequence sequence;
  reeb::tools::ReadReport report;
  check(reeb::tools::read_sequence({argv + 3, argv + argc}, {}, sequence, report));
  std::puts("sequence,profile,threads,Mvertices_per_s,times_one_thread,times_one_thread_groups");
  for (const reeb::Profile profile : {reeb::Profile::kMain, reeb::Profile::kFast})
    measure(argv[3], sequence, profile, static_cast<unsigned>(threads), rounds);
  return 0;
}
