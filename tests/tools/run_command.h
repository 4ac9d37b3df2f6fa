// Runs the built `reeb`.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/tools/temp_folder.h"

namespace reeb::tools {

struct CommandResult {
  int exit_code = -1;  ///< -1 where a signal ended it
  std::string out;
  std::string err;
};

/// Starts `reeb ARGUMENTS` with standard input, output and error as given; gives the process id.
/// `prepare` is called in the new process before.
inline pid_t start_reeb(const std::vector<std::string>& arguments, const std::string& in,
                        const std::string& out, const std::string& err,
                        const std::function<void()>& prepare = {}) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const auto connect = [](const std::string& path, int flags, int descriptor) {
    const int file = ::open(path.c_str(), flags, 0644);
    if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(99);
  };
  connect(in, O_RDONLY, STDIN_FILENO);
  connect(out, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  connect(err, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  if (prepare) prepare();
  std::vector<char*> argv{const_cast<char*>(REEB_COMMAND)};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(REEB_COMMAND, argv.data());
  ::_exit(98);
}

inline int exit_code_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

inline CommandResult run_reeb(const std::vector<std::string>& arguments,
                              const std::string& in = "/dev/null",
                              const std::function<void()>& prepare = {}) {
  const TempFolder folder;
  CommandResult result;
  result.exit_code =
      exit_code_of(start_reeb(arguments, in, folder / "out", folder / "err", prepare));
  result.out = read_text(folder / "out");
  result.err = read_text(folder / "err");
  return result;
}

}  // namespace reeb::tools
