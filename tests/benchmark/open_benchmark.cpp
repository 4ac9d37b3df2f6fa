// What opening costs a fresh process: the first frame of a file, and the first frame of the same
// file opened once more in the same process, which has its memory from then on.
//
// open_benchmark ROUNDS FILE...: a line of CSV for each file, from the least processor times of
// ROUNDS processes, with page faults.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "codec/dec/decoder.h"

namespace {

constexpr int kOpenings = 3;

struct Cost {
  double ms = 1e9;
  long faults = 0;
};
struct Costs {
  Cost opening[kOpenings];
};

double cpu_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

long page_faults() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

bool open_first_frame(const std::vector<uint8_t>& file, float* xyz) {
  std::unique_ptr<reeb::Decoder> decoder;
  return reeb::Decoder::open(file, {}, decoder).ok() && decoder->decode_frame(0, xyz).ok();
}

/// `xyz`: touched already, as a player's buffer is.
Costs measure(const std::vector<uint8_t>& file, float* xyz) {
  Costs costs;
  for (Cost& cost : costs.opening) {
    const double start = cpu_ms();
    const long faults = page_faults();
    if (!open_first_frame(file, xyz)) std::exit(1);
    cost = {cpu_ms() - start, page_faults() - faults};
  }
  return costs;
}

/// In a process of its own, which inherits no memory that an opening has used.
Costs measure_fresh(const std::vector<uint8_t>& file, std::vector<float>& xyz) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(1);
  const pid_t child = fork();
  if (child == 0) {
    std::fill(xyz.begin(), xyz.end(), 1.0f);
    const Costs costs = measure(file, xyz.data());
    _exit(write(ends[1], &costs, sizeof costs) == sizeof costs ? 0 : 1);
  }
  Costs costs;
  const bool ok = read(ends[0], &costs, sizeof costs) == sizeof costs;
  close(ends[0]);
  close(ends[1]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!ok || status != 0) std::exit(1);
  return costs;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  constexpr size_t kMaxVertices = 1u << 20;
  std::vector<float> xyz(3 * kMaxVertices);
  std::puts("file,first ms,second ms,third ms,first to second,first faults,second faults");
  for (int i = 2; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const std::vector<uint8_t> file(std::istreambuf_iterator<char>(in), {});
    Costs least;
    for (int round = 0; round < std::atoi(argv[1]); ++round) {
      const Costs costs = measure_fresh(file, xyz);
      for (int k = 0; k < kOpenings; ++k) {
        if (costs.opening[k].ms < least.opening[k].ms) least.opening[k] = costs.opening[k];
      }
    }
    const Cost* o = least.opening;
    std::printf("%s,%.2f,%.2f,%.2f,%.2f,%ld,%ld\n", argv[i], o[0].ms, o[1].ms, o[2].ms,
                o[0].ms / o[1].ms, o[0].faults, o[1].faults);
  }
  return 0;
}
