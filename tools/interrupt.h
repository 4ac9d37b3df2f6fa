// Ctrl-C and termination.
#pragma once

namespace reeb::tools {

/// From here on SIGINT, SIGTERM and SIGHUP remove all unfinished output (see OutputSet) and end the
/// program with 128 + their number, at once, whatever its threads are doing. One that is ignored
/// (nohup, a job of a script in the background) stays ignored. To be called first in main.
void remove_output_on_interrupt();

}  // namespace reeb::tools
