// Long work beside the interpreter: its lock is released meanwhile, and Ctrl-C is heard.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <future>
#include <utility>

namespace reeb_python {

namespace nb = nanobind;

/// True where Python runs its signal handlers: in its main thread.
bool in_main_thread();

/// How often a waiting call looks after signals.
inline constexpr std::chrono::milliseconds kSignalPeriod{50};

/// Runs `work` on a thread of its own and gives its result. Meanwhile `watch` is called, with the
/// interpreter's lock; where it throws, e.g. a KeyboardInterrupt, `stop` is to make `work` end
/// soon, and what was thrown goes on when it has.
template <class Work, class Stop, class Watch>
auto run_job(Work&& work, Stop&& stop, Watch&& watch) {
  std::future job = std::async(std::launch::async, std::forward<Work>(work));
  const auto ended = [&](std::chrono::milliseconds time) {
    const nb::gil_scoped_release release;
    return job.wait_for(time) == std::future_status::ready;
  };
  try {
    while (!ended(kSignalPeriod)) {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      watch();
    }
  } catch (...) {
    stop();
    const nb::gil_scoped_release release;
    job.wait();
    throw;
  }
  return job.get();
}

}  // namespace reeb_python
