#include "tools/terminal.h"

#include <sys/ioctl.h>

#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace reeb::tools {

size_t terminal_width(std::FILE* stream) {
  size_t width = 0;
  if (const char* const columns = std::getenv("COLUMNS")) {
    const std::string_view text(columns);
    std::from_chars(text.data(), text.data() + text.size(), width);
  }
  winsize size{};
  if (width == 0 && ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width == 0 ? 80 : width;
}

std::string wrapped(const std::string& text, size_t width) {
  std::istringstream lines(text);
  std::string out, line, word;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    size_t used = 0;
    if (!out.empty()) out += '\n';
    while (words >> word) {
      const bool fits = used + 1 + word.size() <= width;
      if (used > 0) out += fits ? ' ' : '\n';
      used = used > 0 && fits ? used + 1 + word.size() : word.size();
      out += word;
    }
  }
  return out;
}

}  // namespace reeb::tools
