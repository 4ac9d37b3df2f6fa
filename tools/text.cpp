#include "tools/text.h"

#include <algorithm>
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

std::string plain(double value, int digits) {
  const double size = std::abs(value);
  if (!(size >= 1e-6 && size < 1e15)) return brief(value, digits);
  const int places = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  const double unit = std::pow(10, std::max(0, -places));
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", std::max(0, places),
                places < 0 ? std::round(size / unit) * unit : size);
  std::string text(buffer.data());
  const size_t point = std::min(text.find('.'), text.size());
  std::string fraction = text.substr(point);
  fraction.erase(fraction.find_last_not_of(".0") + 1);
  std::string out(value < 0 ? "-" : "");
  out += grouped(std::stoull(text.substr(0, point)));
  return out += fraction;
}

std::string counted(uint64_t value, const std::string& noun) {
  if (value == 1) return "1 " + noun;
  return grouped(value) + " " + (noun == "vertex" ? "vertices" : noun + "s");
}

std::string byte_size(uint64_t bytes) {
  if (bytes < 10'000) return grouped(bytes) + " bytes";
  if (bytes < 1'000'000) return plain(static_cast<double>(bytes) / 1e3) + " kB";
  if (bytes < 1'000'000'000) return plain(static_cast<double>(bytes) / 1e6) + " MB";
  return plain(static_cast<double>(bytes) / 1e9) + " GB";
}

}  // namespace reeb::tools
