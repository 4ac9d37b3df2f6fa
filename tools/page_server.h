// Serves the built player and the files that it shows, on this machine alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

struct PageOptions {
  std::string page;                ///< folder of the built player
  std::vector<std::string> files;  ///< one, or two to compare
  int port = 0;                    ///< 0: any that is free
};

/// The folder of the player beside this program, as it is installed; empty where there is none.
std::string installed_page();

/// Listens on the loopback interface, calls `ready` with the address of the page, and answers until
/// the process ends. Requests that name another host are refused, so that no page of another place
/// reads the files by a name of its own.
Status serve_page(const PageOptions& options,
                  const std::function<void(const std::string& address)>& ready);

}  // namespace reeb::tools
