// Loop over a range on several threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "codec/common/base/float_state.h"

namespace reeb {

/// Number of threads to use for a request of `threads`, 0 meaning all cores.
inline unsigned resolve_threads(unsigned threads) {
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

/// Calls function(begin, end) on contiguous parts of [0, count), one part per thread, and waits.
/// Where the system gives no more threads, this one does their parts. The first exception of any
/// part is thrown on, after all have ended.
template <class Function>
void parallel_ranges(uint32_t count, unsigned threads, Function function) {
  const uint32_t parts = std::min(count, threads);
  if (parts <= 1) {
    if (count > 0) function(0u, count);
    return;
  }
  std::vector<std::exception_ptr> failures(parts);
  const auto run = [&](uint32_t part) noexcept {
    const FloatState state;
    const auto bound = [&](uint32_t p) {
      return static_cast<uint32_t>(uint64_t{count} * p / parts);
    };
    try {
      function(bound(part), bound(part + 1));
    } catch (...) {
      failures[part] = std::current_exception();
    }
  };
  std::vector<std::thread> workers;
  workers.reserve(parts);
  uint32_t started = 1;
  try {
    for (; started < parts; ++started) workers.emplace_back(run, started);
  } catch (const std::exception&) {  // no thread, or no memory for one
    for (uint32_t part = started; part < parts; ++part) run(part);
  }
  run(0);
  for (std::thread& worker : workers) worker.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace reeb
