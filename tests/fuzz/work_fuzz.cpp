// A whole stream within the default limits, its checksums repaired: opening it and decoding a group
// must not take more processor time or memory than spec/levels.md says that its bytes can ask for.
#include <sanitizer/allocator_interface.h>

#include <atomic>
#include <ctime>
#include <vector>

#include "codec/dec/decoder.h"
#include "tests/codec/damage.h"

namespace {

constexpr double kSlowness = 15;  // of a build with sanitizers on a busy machine
constexpr double kSeconds = 0.1, kSecondsPerByte = 0.75e-3;
constexpr size_t kMemory = size_t{1} << 20, kMemoryPerByte = size_t{256} << 10;

std::atomic<size_t> held{0}, most{0};

void note_allocation(const volatile void* block, size_t size) {
  if (block == nullptr) return;
  const size_t now = held += size;
  if (now > most) most = now;
}

void note_release(const volatile void* block) {
  if (block != nullptr) held -= __sanitizer_get_allocated_size(const_cast<const void*>(block));
}

void decode(std::span<const uint8_t> bytes) {
  std::unique_ptr<reeb::Decoder> decoder;
  if (!reeb::Decoder::open(bytes, {}, decoder).ok()) return;
  for (const auto& group : decoder->info().groups) {
    const reeb::Connectivity* connectivity = nullptr;
    if (!decoder->connectivity(group.first_frame, connectivity).ok()) continue;
    std::vector<float> xyz(size_t{connectivity->vertex_count} * 3);
    (void)decoder->decode_frame(group.first_frame, xyz.data());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const int hooked =
      __sanitizer_install_malloc_and_free_hooks(note_allocation, note_release);
  if (hooked == 0) __builtin_trap();
  std::vector<uint8_t> file(data, data + size);
  reeb::test::repair_checksums(file);
  const size_t before = held;
  most = before;
  const std::clock_t start = std::clock();
  decode(file);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto bytes = static_cast<double>(size);
  if (seconds > kSlowness * (kSeconds + kSecondsPerByte * bytes)) __builtin_trap();
  if (most - before > kMemory + kMemoryPerByte * size) __builtin_trap();
  return 0;
}
