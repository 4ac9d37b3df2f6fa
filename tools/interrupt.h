// Ctrl-C and termination.
#pragma once

namespace reeb::tools {

inline constexpr int kExitInterrupted = 130;

/// From here on SIGINT, SIGTERM and SIGHUP remove all unfinished output (see OutputSet) and end the
/// program with kExitInterrupted, at once, whatever its threads are doing. To be called first in
/// main.
void remove_output_on_interrupt();

}  // namespace reeb::tools
