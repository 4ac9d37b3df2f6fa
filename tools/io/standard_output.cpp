#include "tools/io/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace reeb::tools {

bool is_standard_output(const std::string& name) {
  return name == "-" || name == "/dev/stdout" || name == "/dev/fd/1" || name == "/proc/self/fd/1";
}

Status write_standard_output(std::string_view bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  if (written && std::fflush(stdout) == 0) return {};
  return Status::io(std::string("standard output: cannot be written (") + std::strerror(errno) +
                    ")");
}

Status refuse_terminal(const std::string& target, bool force) {
  bool terminal = is_standard_output(target) && ::isatty(STDOUT_FILENO) != 0;
  std::error_code ignored;
  if (!terminal && std::filesystem::is_character_file(target, ignored)) {
    const int file = ::open(target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    terminal = file >= 0 && ::isatty(file) != 0;
    if (file >= 0) ::close(file);
  }
  if (!terminal || force) return {};
  return Status::io(
      "the output is a terminal, which takes no binary data; name a file, redirect "
      "it, or pass -f");
}

}  // namespace reeb::tools
