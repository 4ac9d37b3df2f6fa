#include "tools/console.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tools/terminal.h"

namespace reeb::tools {
namespace {

constexpr size_t kBarWidth = 30, kLeastBarWidth = 5;
constexpr size_t kTimeWidth = 15;      ///< of ", 1:00:00 left"
constexpr double kSecondsUnknown = 2;  ///< before, the time to go would be a guess
constexpr std::chrono::milliseconds kBarInterval(100);

/// "0:07", "12:34", "1:02:03".
std::string clock_text(double seconds) {
  const auto s = static_cast<unsigned long long>(std::ceil(seconds));
  std::array<char, 48> text{};
  if (s < 3600) {
    std::snprintf(text.data(), text.size(), "%llu:%02llu", s / 60, s % 60);
  } else {
    std::snprintf(text.data(), text.size(), "%llu:%02llu:%02llu", s / 3600, s / 60 % 60, s % 60);
  }
  return text.data();
}

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

// A bar never goes back.
void Console::draw(const std::string& label, double done) {
  const auto now = std::chrono::steady_clock::now();
  if (label != label_) {
    label_ = label;
    part_ = 0;
    start_ = now;
  }
  const double part = std::clamp(done, part_, 1.0);
  const bool finished = part == 1 && part_ < 1;
  part_ = part;
  if (bar_visible_ && !finished && now - last_draw_ < kBarInterval) return;
  last_draw_ = now;
  bar_visible_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = seconds < kSecondsUnknown || part == 0 ? -1 : seconds * (1 - part) / part;
  // One column stays free, since some terminals wrap after the last.
  std::fprintf(stderr, "\r%s\033[K",
               bar_text(label, part, left, terminal_width(stderr) - 1).c_str());
  std::fflush(stderr);
}

void Console::clear_bar() {
  if (!bar_visible_) return;
  std::fputs("\r\033[K", stderr);
  bar_visible_ = false;
}

std::string bar_text(const std::string& label, double part, double seconds_left, size_t width) {
  std::array<char, 16> percent{};
  std::snprintf(percent.data(), percent.size(), "%3.0f %%", std::floor(100 * part));
  std::string text = label + " ";
  const size_t rest = text.size() + std::strlen(percent.data()) + 3;
  const size_t room = width > rest ? width - rest : 0;
  const bool timed = room >= kLeastBarWidth + kTimeWidth;
  const size_t bar = std::min(kBarWidth, timed ? room - kTimeWidth : room);
  if (bar >= kLeastBarWidth) {
    const auto filled = static_cast<size_t>(part * static_cast<double>(bar));
    text.append("[").append(filled, '#').append(bar - filled, ' ').append("] ");
  }
  text += percent.data();
  if (timed && seconds_left >= 0)
    text.append(", ").append(clock_text(seconds_left)).append(" left");
  return text.substr(0, width);
}

}  // namespace reeb::tools
