// A loop over independent items on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace reeb::tools {

/// `threads`, or the number of cores where it is 0.
inline unsigned thread_count(unsigned threads) {
  if (threads != 0) return threads;
  const unsigned cores = std::thread::hardware_concurrency();
  return cores == 0 ? 1 : cores;
}

/// Calls body(0) .. body(count-1), each once, on at most `threads` threads (0 = all cores). The
/// body must not throw.
template <typename Body>
void parallel_for(size_t count, unsigned threads, const Body& body) {
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < count; i = next++) body(i);
  };
  std::vector<std::jthread> helpers;
  for (size_t i = 1; i < thread_count(threads) && i < count; ++i) helpers.emplace_back(work);
  work();
}

}  // namespace reeb::tools
