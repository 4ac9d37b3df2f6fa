// Any bytes through the container: parsing, and the trace for people.
#include "bitstream/container.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::span<const uint8_t> bytes(data, size);
  reeb::ContainerReader reader;
  const bool ok = reader.parse(bytes, {}).ok();
  uint64_t sum = 0;
  for (const auto& [name, count] : reader.sections) sum += count;
  if (ok && sum != size) __builtin_trap();
  reeb::trace(bytes);
  return 0;
}
