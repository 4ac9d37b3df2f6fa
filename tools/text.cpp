#include "tools/text.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace reeb::tools {

std::string grouped(uint64_t value) {
  std::string text = std::to_string(value);
  for (size_t i = text.size(); i > 3;) {
    i -= 3;
    text.insert(i, 1, ',');
  }
  return text;
}

std::string brief(double value, int digits) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return buffer.data();
}

std::string counted(uint64_t value, const std::string& noun) {
  if (value == 1) return "1 " + noun;
  return grouped(value) + " " + (noun == "vertex" ? "vertices" : noun + "s");
}

std::string byte_size(uint64_t bytes) {
  if (bytes < 10'000) return grouped(bytes) + " bytes";
  if (bytes < 1'000'000) return brief(static_cast<double>(bytes) / 1e3) + " kB";
  if (bytes < 1'000'000'000) return brief(static_cast<double>(bytes) / 1e6) + " MB";
  return brief(static_cast<double>(bytes) / 1e9) + " GB";
}

}  // namespace reeb::tools
