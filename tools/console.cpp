#include "tools/console.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace reeb::tools {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarInterval(100);

void print_line(const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }

}  // namespace

Console::Console(const ConsoleOptions& options)
    : options_(options),
      show_bar_(options.progress == ProgressMode::kAlways ||
                (options.progress == ProgressMode::kAuto && !options.quiet &&
                 isatty(STDERR_FILENO) != 0)) {}

void Console::error(const std::string& text) {
  clear_bar();
  print_line("reeb: " + text);
}

void Console::say(const std::string& text) {
  if (options_.quiet) return;
  clear_bar();
  print_line(text);
}

void Console::say_all(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) say(text);
}

void Console::detail(const std::string& text) {
  if (options_.verbose) say(text);
}

std::function<void(double)> Console::bar(const std::string& label) {
  if (!show_bar_) return {};
  return [this, label](double done) { draw(label, done); };
}

void Console::draw(const std::string& label, double done) {
  const auto now = std::chrono::steady_clock::now();
  if (bar_visible_ && done < 1 && now - last_draw_ < kBarInterval) return;
  last_draw_ = now;
  bar_visible_ = true;
  const double part = std::clamp(done, 0.0, 1.0);
  const auto filled = static_cast<size_t>(part * kBarWidth);
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, ' ');
  std::fprintf(stderr, "\r%-8s [%s] %3.0f %%", label.c_str(), bar.c_str(), 100 * part);
  std::fflush(stderr);
}

void Console::clear_bar() {
  if (!bar_visible_) return;
  std::fputs("\r\033[K", stderr);
  bar_visible_ = false;
}

}  // namespace reeb::tools
