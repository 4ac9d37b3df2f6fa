// What the commands tell the user, on standard error.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace reeb::tools {

enum class ProgressMode { kAuto, kAlways, kNever };

/// Options that all commands share.
struct ConsoleOptions {
  bool quiet = false;
  bool verbose = false;
  ProgressMode progress = ProgressMode::kAuto;  ///< auto: on a terminal
};

class Console {
 public:
  explicit Console(const ConsoleOptions& options);
  ~Console() { clear_bar(); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Always shown, behind "reeb: ".
  void error(const std::string& text);
  /// Shown unless quiet.
  void say(const std::string& text);
  void say_all(const std::vector<std::string>& texts);
  /// Shown when verbose.
  void detail(const std::string& text);
  /// A function that draws a bar for the done part in [0,1] of the work called `label`, where
  /// wanted.
  std::function<void(double)> bar(const std::string& label);
  /// To be called before anything else writes to the terminal.
  void clear_bar();

 private:
  void draw(const std::string& label, double done);

  ConsoleOptions options_;
  bool show_bar_;
  bool bar_visible_ = false;
  std::string label_;  ///< of the bar drawn last
  double part_ = 0;    ///< that it showed
  std::chrono::steady_clock::time_point start_, last_draw_;
};

/// "reading [####      ]  40 %, 1:05 left" in at most `width` columns: on a narrow terminal without
/// the time, then without the bar. `seconds_left` below 0: unknown.
std::string bar_text(const std::string& label, double part, double seconds_left, size_t width);

}  // namespace reeb::tools
