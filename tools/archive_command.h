// `reeb index` and `reeb search`.
#pragma once

#include "tools/command.h"

namespace reeb::tools {

void add_index_command(CLI::App& app, int& exit_code);
void add_search_command(CLI::App& app, int& exit_code);

}  // namespace reeb::tools
