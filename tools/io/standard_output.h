// Standard output: data for other programs.
#pragma once

#include <string>
#include <string_view>

#include "bitstream/status.h"

namespace reeb::tools {

/// True for the names that mean standard output: -, /dev/stdout and the like.
bool is_standard_output(const std::string& name);

/// Fails where not all of it arrives: a full device, a closed pipe.
Status write_standard_output(std::string_view bytes);

/// Why bytes that are no text must not go to `target`: it is a terminal, and `force` not given.
Status refuse_terminal(const std::string& target, bool force);

}  // namespace reeb::tools
