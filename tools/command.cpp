#include "tools/command.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

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
                  "Progress bar: auto (on a terminal), always or never; default auto")
      ->transform(CLI::Transformer(modes).description(""))
      ->check(CLI::IsMember({ProgressMode::kAuto, ProgressMode::kAlways, ProgressMode::kNever})
                  .description(""))
      ->type_name("MODE")
      ->group(group);
}

void add_threads_option(CLI::App& command, unsigned& threads) {
  command.add_option("-T,--threads", threads, "Threads, 0 to 1024; 0 = all cores; default 0")
      ->check(CLI::Range(0u, 1024u).description(""))
      ->type_name("N")
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

std::string parse_absolute_or_percent(const std::string& text, AbsoluteOrPercent& out) {
  std::string rest;
  if (!parse_positive(text, out.value, rest) || (!rest.empty() && rest != "%")) {
    return "'" + text + "' is not a positive number, or one followed by %";
  }
  out.percent = !rest.empty();
  return {};
}

std::string parse_byte_count(const std::string& text, double& out) {
  static constexpr std::array<std::pair<const char*, double>, 9> kUnits{{{"", 1},
                                                                         {"B", 1},
                                                                         {"k", 1e3},
                                                                         {"kB", 1e3},
                                                                         {"M", 1e6},
                                                                         {"MB", 1e6},
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
  return "'" + text + "' is not a number of bytes (suffixes k, M, KiB, MiB, GiB)";
}

}  // namespace reeb::tools
