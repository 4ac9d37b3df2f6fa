#include "tools/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <thread>

#include "tools/io/output_set.h"

namespace reeb::tools {

void remove_output_on_interrupt() {
  // A file that grows beyond the limit is then a write that fails, like any other.
  std::signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  // Blocked here, hence in every thread to come; one thread waits for them and may take locks and
  // touch files, which a signal handler must not.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int received = 0;
    sigwait(&signals, &received);
    OutputSet::abandon_all();
    std::fprintf(stderr, "\nreeb: %s; nothing unfinished is left\n",
                 received == SIGINT ? "interrupted" : "terminated");
    _exit(128 + received);
  }).detach();
}

}  // namespace reeb::tools
