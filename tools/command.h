// The sub-commands of `reeb`. Each adds itself to the application; when it has been called, it
// leaves its exit code in `exit_code`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "tools/console.h"

namespace reeb::tools {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;         ///< input or output, or bad data
inline constexpr int kExitUsage = 2;          ///< the command line
inline constexpr int kExitOverTolerance = 3;  ///< a comparison

void add_encode_command(CLI::App& app, int& exit_code);
void add_decode_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_verify_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_sample_command(CLI::App& app, int& exit_code);
void add_picture_command(CLI::App& app, int& exit_code);
void add_plot_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);

/// -q, -v, --progress.
void add_console_options(CLI::App& command, ConsoleOptions& options);

/// -T/--threads.
void add_threads_option(CLI::App& command, unsigned& threads);

/// --memory-limit, of commands that decode; `bytes` has the default.
void add_memory_limit_option(CLI::App& command, uint64_t& bytes);

/// Check of an option: a number above 0, or not below it. Unlike the library's own, they say so.
std::string check_positive(const std::string& text);
std::string check_not_negative(const std::string& text);

/// Shows the message of a failed status and gives its exit code.
int fail(Console& console, const Status& status);

/// Writes to standard output and gives the exit code; a full device or a closed pipe is an error.
int print(const std::string& text);
/// The same where a bar may be shown, which goes first: both may be on one terminal.
int print(const std::string& text, Console& console);

/// The names of several sequences: a mesh before a point cache goes with it, from the left, as long
/// as more than `least` sequences remain.
std::vector<std::vector<std::string>> split_sequences(const std::vector<std::string>& names,
                                                      size_t least);

/// Empty where `output` ends in `extension`, in any case, or is no plain file; what is wrong
/// otherwise.
std::string check_extension(const std::string& output, const std::string& extension);

/// A positive number with an optional suffix: "0.01" or "0.1%".
struct AbsoluteOrPercent {
  double value = 0;
  bool percent = false;

  /// In the unit of `whole`.
  double of(double whole) const { return percent ? value / 100 * whole : value; }
};

/// Empty where `text` is good, what is wrong otherwise (as CLI11 wants its checks).
std::string parse_absolute_or_percent(const std::string& text, AbsoluteOrPercent& out);

/// "1500000", "1.5M", "2MiB", "500k", "64KiB", "2G", "1GiB": bytes. Result as above.
std::string parse_byte_count(const std::string& text, double& out);

}  // namespace reeb::tools
