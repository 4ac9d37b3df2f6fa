// Terminals: how wide they are, and text that fits.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace reeb::tools {

/// Columns of the terminal that `stream` goes to, or of the environment variable COLUMNS, which
/// comes first; 80 where neither tells.
size_t terminal_width(std::FILE* stream);

/// `text` with line breaks for blanks so that no line is longer than `width`, but for longer words.
std::string wrapped(const std::string& text, size_t width);

}  // namespace reeb::tools
