// `reeb segment`: the regions and the Reeb graph of a sequence, as files to look at.
#pragma once

#include <CLI/CLI.hpp>

namespace reeb::tools {

void add_segment_command(CLI::App& app, int& exit_code);

}  // namespace reeb::tools
