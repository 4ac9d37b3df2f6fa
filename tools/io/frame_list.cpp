#include "tools/io/frame_list.h"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>

#include "tools/io/mesh_file.h"
#include "tools/io/point_cache.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Runs of digits and runs of other characters, in turn.
std::vector<std::string> pieces(const std::string& text) {
  std::vector<std::string> out;
  for (size_t i = 0; i < text.size();) {
    size_t end = i + 1;
    while (end < text.size() && is_digit(text[end]) == is_digit(text[i])) ++end;
    out.push_back(text.substr(i, end - i));
    i = end;
  }
  return out;
}

std::string without_zeros(const std::string& digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

int compare_numbers(const std::string& a, const std::string& b) {
  const std::string x = without_zeros(a);
  const std::string y = without_zeros(b);
  if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
  return x.compare(y);
}

bool is_stream(const fs::path& path) { return path == "-" || path.extension() == ".reeb"; }

Status no_files(const std::string& input) {
  return Status::io(input + ": no such file, and no files match; check the name");
}

// Meshes and caches of a folder; hidden files are left out.
Status list_folder(const fs::path& folder, std::vector<fs::path>& out) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path& path = entry.path();
    if (path.filename().string().starts_with('.')) continue;
    if (mesh_format(path) || cache_format(path)) out.push_back(path);
  }
  if (failed) return Status::io(folder.string() + ": cannot be listed (" + failed.message() + ")");
  if (out.empty()) {
    return Status::io(folder.string() + ": holds no .obj, .ply, .off, .stl, .pc2 or .mdd file");
  }
  return {};
}

void match_numbers(const NumberPattern& pattern, std::vector<fs::path>& out) {
  fs::path folder = fs::path(pattern.prefix).parent_path();
  const bool bare = folder.empty();
  if (bare) folder = ".";
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path path = bare ? entry.path().filename() : entry.path();
    if (pattern.matches(path.string())) out.push_back(path);
  }
}

void match_wildcards(const std::string& pattern, std::vector<fs::path>& out) {
  glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    out.insert(out.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
}

// Files named by one argument.
Status expand(const std::string& input, std::vector<fs::path>& out) {
  std::error_code ignored;
  const fs::file_status kind = fs::status(input, ignored);
  if (fs::is_directory(kind)) return list_folder(input, out);
  if (input == "-" || fs::exists(kind)) {
    out.emplace_back(input);
    return {};
  }
  const size_t before = out.size();
  NumberPattern numbers;
  if (NumberPattern::parse(input, numbers)) {
    match_numbers(numbers, out);
  } else if (input.find_first_of("*?[") != input.npos) {
    match_wildcards(input, out);
  }
  return out.size() == before ? no_files(input) : Status();
}

/// Where the names of all files differ in exactly one number: its place among the pieces.
std::optional<size_t> numbered_piece(const std::vector<std::vector<std::string>>& names) {
  std::optional<size_t> place;
  for (const auto& name : names) {
    if (name.size() != names[0].size()) return std::nullopt;
    for (size_t i = 0; i < name.size(); ++i) {
      if (name[i] == names[0][i]) continue;
      const bool both_numbers = is_digit(name[i][0]) && is_digit(names[0][i][0]);
      if (!both_numbers || (place && *place != i)) return std::nullopt;
      place = i;
    }
  }
  return place;
}

std::string file_name_with(std::vector<std::string> name, size_t place, unsigned long long number) {
  std::string digits = std::to_string(number);
  const bool padded = name[place].size() > 1 && name[place][0] == '0';
  if (padded && digits.size() < name[place].size()) {
    digits.insert(0, name[place].size() - digits.size(), '0');
  }
  name[place] = digits;
  std::string out;
  for (const std::string& piece : name) out += piece;
  return out;
}

// `files` in natural order.
Status check_numbering(const std::vector<fs::path>& files) {
  std::vector<std::vector<std::string>> names;
  for (const fs::path& file : files) names.push_back(pieces(file.string()));
  const std::optional<size_t> place = numbered_piece(names);
  if (!place) return {};
  for (size_t i = 1; i < names.size(); ++i) {
    if (names[i][*place].size() > 18 || names[i - 1][*place].size() > 18) return {};
    const unsigned long long previous = std::stoull(names[i - 1][*place]);
    const unsigned long long number = std::stoull(names[i][*place]);
    if (number == previous) {
      return Status::corrupt(files[i].string() + " and " + files[i - 1].string() +
                             ": two files have one frame number; remove or rename one");
    }
    if (number != previous + 1) {
      return Status::corrupt(file_name_with(names[i - 1], *place, previous + 1) + ": frame " +
                             std::to_string(previous + 1) + " is missing between " +
                             files[i - 1].string() + " and " + files[i].string() +
                             "; restore it, or pass --allow-gaps to go on without it");
    }
  }
  return {};
}

// The mesh that carries the faces of a lone cache: same folder, same name.
Status mesh_beside(const fs::path& cache, fs::path& out) {
  for (const char* extension : {".obj", ".ply", ".off", ".stl"}) {
    out = cache;
    out.replace_extension(extension);
    if (fs::exists(out)) return {};
  }
  return Status::io(cache.string() + ": a point cache has no faces and there is no " +
                    fs::path(cache).replace_extension(".obj").string() +
                    "; name the mesh before the cache");
}

Status pair_with_cache(const std::vector<fs::path>& files, InputFiles& out) {
  const auto is_cache = [](const fs::path& f) { return cache_format(f).has_value(); };
  const auto cache = std::find_if(files.begin(), files.end(), is_cache);
  const auto count = std::count_if(files.begin(), files.end(), is_cache);
  if (count > 1 || files.size() > 2) {
    return Status::invalid("a point cache goes with exactly one mesh: name one mesh and one cache");
  }
  out.cache = *cache;
  fs::path mesh;
  if (files.size() == 2) {
    mesh = files[cache == files.begin() ? 1 : 0];
  } else if (Status status = mesh_beside(*cache, mesh); !status.ok()) {
    return status;
  }
  out.meshes = {mesh};
  return {};
}

Status check_formats(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (!mesh_format(file)) {
      return Status::invalid(file.string() +
                             ": not a format reeb reads (.obj, .ply, .off, .stl, "
                             ".pc2, .mdd, .reeb)");
    }
    if (mesh_format(file) != mesh_format(files[0])) {
      return Status::invalid(files[0].string() + " and " + file.string() +
                             " differ in format; name the files of one, e.g. by a pattern");
    }
  }
  return {};
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  const std::vector<std::string> x = pieces(a);
  const std::vector<std::string> y = pieces(b);
  for (size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const bool numbers = is_digit(x[i][0]) && is_digit(y[i][0]);
    const int order = numbers ? compare_numbers(x[i], y[i]) : x[i].compare(y[i]);
    if (order != 0) return order < 0;
  }
  return x.size() != y.size() ? x.size() < y.size() : a < b;
}

Status find_input(const std::vector<std::string>& inputs, bool allow_gaps, InputFiles& out) {
  std::vector<fs::path> files;
  for (const std::string& input : inputs) {
    if (Status status = expand(input, files); !status.ok()) return status;
  }
  if (files.empty()) return Status::invalid("no input");
  if (std::any_of(files.begin(), files.end(), is_stream)) {
    if (files.size() != 1)
      return Status::invalid("a .reeb file is a sequence by itself; name just it");
    out.stream = files[0];
    return {};
  }
  if (std::any_of(files.begin(), files.end(),
                  [](const auto& f) { return bool(cache_format(f)); })) {
    return pair_with_cache(files, out);
  }
  if (Status status = check_formats(files); !status.ok()) return status;
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.string(), b.string());
  });
  if (!allow_gaps) {
    if (Status status = check_numbering(files); !status.ok()) return status;
  }
  out.meshes = std::move(files);
  return {};
}

bool NumberPattern::parse(const std::string& text, NumberPattern& out) {
  static const std::regex field("%(0([1-9][0-9]?))?d");
  std::smatch match;
  if (!std::regex_search(text, match, field)) return false;
  out.prefix = match.prefix();
  out.suffix = match.suffix();
  out.digits = match[2].matched ? std::stoul(match[2]) : 0;
  return !std::regex_search(out.suffix, field);
}

std::string NumberPattern::name(int64_t number) const {
  std::string text = std::to_string(number);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  return prefix + text + suffix;
}

bool NumberPattern::matches(const std::string& text) const {
  if (text.size() <= prefix.size() + suffix.size()) return false;
  if (!text.starts_with(prefix) || !text.ends_with(suffix)) return false;
  const std::string number =
      text.substr(prefix.size(), text.size() - prefix.size() - suffix.size());
  const bool width =
      digits == 0 || number.size() == digits || (number.size() > digits && number[0] != '0');
  return width && std::all_of(number.begin(), number.end(), is_digit);
}

}  // namespace reeb::tools
