#include <algorithm>
#include <charconv>

#include "tools/picture/plot.h"

namespace reeb::tools {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> values(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      // Two quotes within quotes are one.
      const bool escaped = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (escaped) values.back() += line[++i];
      if (!escaped) quoted = !quoted;
    } else if (c == ',' && !quoted) {
      values.emplace_back();
    } else if (c != '\r') {
      values.back() += c;
    }
  }
  return values;
}

bool parse_number(const std::string& text, double& out) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && stop == text.data() + text.size();
}

Curve& curve_named(std::vector<Curve>& curves, const std::string& name) {
  const auto found =
      std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
  if (found != curves.end()) return *found;
  return curves.emplace_back(Curve{name, {}});
}

}  // namespace

int CsvTable::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

Status parse_csv(const std::string& text, CsvTable& out) {
  out = CsvTable();
  size_t number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    std::vector<std::string> values = split(line);
    if (out.columns.empty()) {
      out.columns = std::move(values);
    } else if (values.size() == out.columns.size()) {
      out.rows.push_back(std::move(values));
    } else {
      return Status::corrupt("line " + std::to_string(number) + ": " +
                             std::to_string(values.size()) + " values, the header has " +
                             std::to_string(out.columns.size()));
    }
  }
  return {};
}

Status curves_of(const CsvTable& table, const std::string& x, const std::string& y,
                 const std::vector<std::string>& series, std::vector<Curve>& out) {
  out.clear();
  std::vector<size_t> places;
  std::vector<std::string> wanted = series;
  wanted.insert(wanted.begin(), {x, y});
  for (const std::string& name : wanted) {
    const int place = table.find(name);
    if (place < 0) return Status::invalid("there is no column '" + name + "'");
    places.push_back(static_cast<size_t>(place));
  }
  for (const auto& row : table.rows) {
    std::pair<double, double> point;
    if (!parse_number(row[places[0]], point.first) || !parse_number(row[places[1]], point.second)) {
      continue;
    }
    std::string name;
    for (size_t i = 2; i < places.size(); ++i) name += (i > 2 ? " " : "") + row[places[i]];
    curve_named(out, name).points.push_back(point);
  }
  for (Curve& curve : out) std::sort(curve.points.begin(), curve.points.end());
  return out.empty() ? Status::invalid("no row has numbers in '" + x + "' and '" + y + "'")
                     : Status();
}

}  // namespace reeb::tools
