// How `reeb` reads its command line: help as wide as the terminal, `reeb help COMMAND`, and a word
// on what is wrong.
#pragma once

#include <CLI/CLI.hpp>

namespace reeb::tools {

/// To be called before the commands are added, which inherit most of it.
void set_up_command_line(CLI::App& app);

/// `reeb help COMMAND`; to be called after all other commands have been added.
void add_help_command(CLI::App& app, int& exit_code);

}  // namespace reeb::tools
