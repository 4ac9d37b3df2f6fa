// Which program this is.
#pragma once

#include <string>

#include "bitstream/headers.h"

namespace reeb::tools {

/// Version of the library and of the format it writes.
inline std::string version_text() {
  return "reeb " REEB_VERSION ", format version " + std::to_string(kFormatVersion);
}

}  // namespace reeb::tools
