// A whole stream within the default limits, its checksums repaired: opening it and decoding a group
// must not take more processor time or memory than spec/levels.md says that its bytes can ask for.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <vector>

#include "codec/dec/decoder.h"
#include "tests/codec/allocation_meter.h"
#include "tests/codec/damage.h"

namespace {

constexpr double kSlowness = 15;  // of a build with sanitizers on a busy machine
constexpr double kSeconds = 0.1, kSecondsPerByte = 0.75e-3;
constexpr size_t kMemory = size_t{1} << 20, kMemoryPerByte = size_t{256} << 10;
constexpr double kTolerance = 1.02;              // of the heap beyond the decoder's account
constexpr size_t kNotCounted = size_t{1} << 20;  // small: corrections of a frame's grid, for one

/// What decoding took by the decoder's account, and what it was given room for.
size_t decode(std::span<const uint8_t> bytes) {
  std::unique_ptr<reeb::Decoder> decoder;
  if (!reeb::Decoder::open(bytes, {}, decoder).ok()) return SIZE_MAX;
  size_t room = 0;
  for (const auto& group : decoder->info().groups) {
    const reeb::Connectivity* connectivity = nullptr;
    if (!decoder->connectivity(group.first_frame, connectivity).ok()) continue;
    std::vector<float> xyz(size_t{connectivity->vertex_count} * 3);
    room = std::max(room, xyz.size() * sizeof(float));
    (void)decoder->decode_frame(group.first_frame, xyz.data());
  }
  return room + static_cast<size_t>(kTolerance * static_cast<double>(decoder->stats().peak_memory));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<uint8_t> file(data, data + size);
  reeb::test::repair_checksums(file);
  const reeb::test::AllocationMeter meter;
  const std::clock_t start = std::clock();
  const size_t account = decode(file);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto bytes = static_cast<double>(size);
  if (seconds > kSlowness * (kSeconds + kSecondsPerByte * bytes)) __builtin_trap();
  if (meter.peak() > kMemory + kMemoryPerByte * size) __builtin_trap();
  if (meter.peak() > kNotCounted && meter.peak() - kNotCounted > account) __builtin_trap();
  return 0;
}
