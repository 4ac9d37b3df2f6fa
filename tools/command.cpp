#include "tools/command.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "tools/io/mesh_file.h"
#include "tools/io/point_cache.h"
#include "tools/io/standard_output.h"

namespace reeb::tools {
namespace {

// A positive finite number; what follows it goes to `rest`.
bool parse_positive(const std::string& text, double& value, std::string& rest) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value > 0) || std::isinf(value)) return false;
  rest.assign(stop, text.data() + text.size());
  return true;
}

}  // namespace

void add_console_options(CLI::App& command, ConsoleOptions& options) {
  const std::string group = "Messages";
  command.add_flag("-q,--quiet", options.quiet, "Only errors")->group(group);
  command.add_flag("-v,--verbose", options.verbose, "More detail")->group(group);
  const std::map<std::string, ProgressMode> modes{{"auto", ProgressMode::kAuto},
                                                  {"always", ProgressMode::kAlways},
                                                  {"never", ProgressMode::kNever}};
  command
      .add_option("--progress", options.progress,
                  "Progress bar: auto is on a terminal; default auto")
      ->transform(CLI::Transformer(modes).description(""))
      ->check(CLI::IsMember({ProgressMode::kAuto, ProgressMode::kAlways, ProgressMode::kNever})
                  .description(""))
      ->type_name("auto|always|never")
      ->group(group);
}

void add_threads_option(CLI::App& command, unsigned& threads) {
  command.add_option("-T,--threads", threads, "Threads, 0 to 1024; 0 = all cores; default 0")
      ->check(CLI::Range(0u, 1024u).description(""))
      ->type_name("N")
      ->group("Running");
}

void add_memory_limit_option(CLI::App& command, uint64_t& bytes) {
  command
      .add_option_function<std::string>(
          "--memory-limit",
          [&bytes](const std::string& text) {
            double value = 0;
            const std::string bad = parse_byte_count(text, value);
            if (!bad.empty()) throw CLI::ValidationError("--memory-limit", bad);
            bytes = static_cast<uint64_t>(std::min(value, 0x1p62));
          },
          "Bytes of memory that decoding a .reeb file may take; suffixes k, M, G, KiB, MiB, GiB; "
          "default 4GiB")
      ->type_name("BYTES")
      ->group("Running");
}

std::string check_positive(const std::string& text) {
  double value = 0;
  std::string rest;
  return parse_positive(text, value, rest) && rest.empty()
             ? ""
             : "'" + text + "' is not a number above 0";
}

std::string check_not_negative(const std::string& text) {
  double value = 0;
  const bool good = CLI::detail::lexical_cast(text, value) && value >= 0;
  return good ? "" : "'" + text + "' is not a number of 0 or more";
}

int fail(Console& console, const Status& status) {
  console.error(status.message());
  return kExitFailed;
}

int print(const std::string& text) {
  Console console{ConsoleOptions()};
  return print(text, console);
}

int print(const std::string& text, Console& console) {
  console.clear_bar();
  const Status status = write_standard_output(text);
  return status.ok() ? kExitDone : fail(console, status);
}

std::vector<std::vector<std::string>> split_sequences(const std::vector<std::string>& names,
                                                      size_t least) {
  std::vector<std::vector<std::string>> out;
  size_t count = names.size();
  for (const std::string& name : names) {
    const bool paired = count > least && !out.empty() && out.back().size() == 1 &&
                        mesh_format(out.back()[0]) && cache_format(name);
    if (paired) {
      out.back().push_back(name);
      --count;
    } else {
      out.push_back({name});
    }
  }
  return out;
}

std::string check_extension(const std::string& output, const std::string& extension) {
  std::error_code ignored;
  const bool plain_file =
      !is_standard_output(output) && !std::filesystem::is_other(output, ignored);
  const std::string found = std::filesystem::path(output).extension().string();
  if (!plain_file || CLI::detail::to_lower(found) == extension) return {};
  return output + " does not end in " + extension + ", which this command writes" +
         (extension == ".reeb" && (mesh_format(output) || cache_format(output))
              ? "; reeb decode writes meshes"
              : "");
}

std::string parse_absolute_or_percent(const std::string& text, AbsoluteOrPercent& out) {
  std::string rest;
  if (!parse_positive(text, out.value, rest) || (!rest.empty() && rest != "%")) {
    return "'" + text + "' is not a positive number, or one followed by %";
  }
  out.percent = !rest.empty();
  return {};
}

std::string parse_byte_count(const std::string& text, double& out) {
  static constexpr std::array<std::pair<const char*, double>, 11> kUnits{{{"", 1},
                                                                          {"B", 1},
                                                                          {"k", 1e3},
                                                                          {"kB", 1e3},
                                                                          {"M", 1e6},
                                                                          {"MB", 1e6},
                                                                          {"G", 1e9},
                                                                          {"GB", 1e9},
                                                                          {"KiB", 1024},
                                                                          {"MiB", 1048576},
                                                                          {"GiB", 1073741824}}};
  std::string rest;
  if (parse_positive(text, out, rest)) {
    for (const auto& [unit, scale] : kUnits) {
      if (rest != unit) continue;
      out = std::floor(out * scale);
      if (out >= 1) return {};
    }
  }
  return "'" + text + "' is not a number of bytes (suffixes k, M, G, KiB, MiB, GiB)";
}

}  // namespace reeb::tools
