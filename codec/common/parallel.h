// Loop over a range on several threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

namespace reeb {

/// Number of threads to use for a request of `threads`, 0 meaning all cores.
inline unsigned resolve_threads(unsigned threads) {
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

/// Calls function(begin, end) on contiguous parts of [0, count), one part per thread, and waits.
template <class Function>
void parallel_ranges(uint32_t count, unsigned threads, Function function) {
  const uint32_t parts = std::min(count, threads);
  if (parts <= 1) {
    if (count > 0) function(0u, count);
    return;
  }
  const auto bound = [&](uint32_t part) {
    return static_cast<uint32_t>(uint64_t{count} * part / parts);
  };
  std::vector<std::thread> workers;
  for (uint32_t part = 1; part < parts; ++part) {
    workers.emplace_back([&, part] { function(bound(part), bound(part + 1)); });
  }
  function(0u, bound(1));
  for (std::thread& worker : workers) worker.join();
}

}  // namespace reeb
