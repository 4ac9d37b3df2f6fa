#include "tools/io/frame_list.h"

#include <glob.h>

#include <algorithm>
#include <optional>
#include <regex>

#include "tools/io/frame_order.h"
#include "tools/io/mesh_file.h"
#include "tools/io/point_cache.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

bool is_stream(const fs::path& path) { return path == "-" || lower_extension(path) == ".reeb"; }

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

// The folders of a pattern that exist as they stand are no pattern.
std::string with_literal_folders(const std::string& pattern) {
  fs::path literal = fs::path(pattern).parent_path();
  while (!literal.empty() && !fs::exists(literal)) literal = literal.parent_path();
  std::string out;
  for (const char c : literal.string()) {
    if (std::string_view("*?[\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out + pattern.substr(literal.string().size());
}

void match_wildcards(const std::string& pattern, std::vector<fs::path>& out) {
  glob_t found{};
  if (::glob(with_literal_folders(pattern).c_str(), 0, nullptr, &found) == 0) {
    out.insert(out.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
}

/// The files that one argument names.
struct Argument {
  std::vector<fs::path> files;
  bool by_name = false;  ///< the argument is one of them
};

Status expand(const std::string& input, Argument& out) {
  std::error_code ignored;
  const fs::file_status kind = fs::status(input, ignored);
  if (fs::is_directory(kind)) return list_folder(input, out.files);
  if (input == "-" || fs::exists(kind)) {
    out = {{input}, true};
    return {};
  }
  NumberPattern numbers;
  if (NumberPattern::parse(input, numbers)) match_numbers(numbers, out.files);
  // A folder that exists may be named like a printf pattern.
  if (out.files.empty() && input.find_first_of("*?[") != input.npos) {
    match_wildcards(input, out.files);
  }
  return out.files.empty() ? no_files(input) : Status();
}

// The files of a folder or a pattern.
Status put_in_order(bool allow_gaps, std::vector<fs::path>& files,
                    std::vector<std::string>& notes) {
  FrameOrder order = order_by_name(files);
  if (!order.doubt.empty()) {
    return Status::invalid(order.doubt +
                           "; rename or move what does not belong, or name the files one by one");
  }
  if (!order.gap.empty() && !allow_gaps) return Status::corrupt(order.gap);
  if (!order.note.empty()) notes.push_back(order.note);
  files = std::move(order.files);
  return {};
}

// Files named one by one, perhaps by a shell.
Status keep_order(bool allow_gaps, std::vector<fs::path>& files, std::vector<std::string>& notes) {
  FrameOrder order = order_by_name(files);
  if (order.files != files) {
    if (!std::is_sorted(files.begin(), files.end())) return {};
    if (!order.doubt.empty()) {
      return Status::invalid(order.doubt +
                             ", and the order is that of a shell (1, 10, 2); leave "
                             "out what does not belong, or name a folder");
    }
    notes.push_back(files[0].string() + " and " + grouped(files.size() - 1) +
                    " more: ordered by number, not as a shell sorts files (1, 10, 2)");
    files = std::move(order.files);
  }
  if (!order.gap.empty() && !allow_gaps) return Status::corrupt(order.gap);
  if (!order.doubt.empty()) notes.push_back(order.doubt + "; the order given is kept");
  return {};
}

Status put_in_order(std::vector<Argument>& arguments, bool allow_gaps, InputFiles& out) {
  const bool one_by_one =
      arguments.size() > 1 &&
      std::all_of(arguments.begin(), arguments.end(), [](const Argument& a) { return a.by_name; });
  for (Argument& argument : arguments) {
    if (Status status = put_in_order(allow_gaps, argument.files, out.notes); !status.ok())
      return status;
    out.meshes.insert(out.meshes.end(), argument.files.begin(), argument.files.end());
  }
  return one_by_one ? keep_order(allow_gaps, out.meshes, out.notes) : Status();
}

// The mesh that carries the faces of a lone cache: same folder, same name, an extension in any
// case.
Status mesh_beside(const fs::path& cache, fs::path& out) {
  const fs::path folder = cache.has_parent_path() ? cache.parent_path() : ".";
  std::optional<MeshFormat> best;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path name = entry.path().filename();
    const std::optional<MeshFormat> format = mesh_format(name);
    if (!format || name.stem() != cache.stem() || (best && *best <= *format)) continue;
    best = format;
    out = cache.parent_path() / name;
  }
  if (best) return {};
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

Status find_input(const std::vector<std::string>& inputs, bool allow_gaps, InputFiles& out) {
  std::vector<Argument> arguments(inputs.size());
  std::vector<fs::path> files;
  for (size_t i = 0; i < inputs.size(); ++i) {
    if (Status status = expand(inputs[i], arguments[i]); !status.ok()) return status;
    files.insert(files.end(), arguments[i].files.begin(), arguments[i].files.end());
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
  return put_in_order(arguments, allow_gaps, out);
}

bool NumberPattern::parse(const std::string& text, NumberPattern& out) {
  static const std::regex field("%(0([1-9][0-9]?))?d");
  const size_t slash = text.rfind('/');
  const size_t name = slash == text.npos ? 0 : slash + 1;
  const bool in_name = std::regex_search(text.substr(name), field);
  const std::string searched = in_name ? text.substr(name) : text;
  std::smatch match;
  if (!std::regex_search(searched, match, field)) return false;
  out.prefix = (in_name ? text.substr(0, name) : "") + match.prefix().str();
  out.suffix = match.suffix();
  out.digits = match[2].matched ? std::stoul(match[2]) : 0;
  return !std::regex_search(out.suffix, field);
}

std::string NumberPattern::name(int64_t number) const {
  std::string text = std::to_string(number);
  if (text.size() < digits) text.insert(number < 0 ? 1 : 0, digits - text.size(), '0');
  return prefix + text + suffix;
}

bool NumberPattern::matches(const std::string& text) const {
  if (text.size() <= prefix.size() + suffix.size()) return false;
  if (!text.starts_with(prefix) || !text.ends_with(suffix)) return false;
  const std::string number =
      text.substr(prefix.size(), text.size() - prefix.size() - suffix.size());
  const std::string unsigned_number = number.substr(number[0] == '-' ? 1 : 0);
  const bool width = digits == 0 || number.size() == digits ||
                     (number.size() > digits && unsigned_number[0] != '0');
  return width && !unsigned_number.empty() &&
         std::all_of(unsigned_number.begin(), unsigned_number.end(), is_digit);
}

}  // namespace reeb::tools
