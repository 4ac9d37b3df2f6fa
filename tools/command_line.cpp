#include "tools/command_line.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "tools/command.h"
#include "tools/terminal.h"

namespace reeb::tools {
namespace {

constexpr size_t kNameColumn = 30;
constexpr size_t kLeastWidth = 40;

/// CLI11's help, broken at the width of the terminal.
class WrappedHelp : public CLI::Formatter {
 public:
  WrappedHelp() {
    width_ = std::max(kLeastWidth, terminal_width(stdout));
    column_width(std::min(kNameColumn, width_ / 3));
  }

  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), width_) + "\n";
  }
  std::string make_footer(const CLI::App* app) const override {
    return app->get_footer().empty() ? "" : wrapped(app->get_footer(), width_) + "\n";
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_name(), in_column(command->get_description()),
                             column_width_);
    return out.str();
  }
  // What an option excludes goes behind its description, where it can be broken.
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string text = CLI::Formatter::make_option_opts(option);
    return text.substr(0, text.find(" Excludes:"));
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string rivals;
    for (const CLI::Option* other : option->get_excludes())
      rivals += (rivals.empty() ? " (not with " : ", ") + other->get_name();
    return in_column(option->get_description() + rivals + (rivals.empty() ? "" : ")"));
  }

 private:
  std::string in_column(const std::string& text) const {
    return wrapped(text, width_ - column_width_);
  }

  size_t width_;
};

/// Insertions, deletions, replacements and swaps of neighbours that make `b` of `a`.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string unknown_command(const CLI::App& app, const std::string& typed) {
  std::string nearest;
  size_t least = typed.size() / 3 + 2;  // further away is no misspelling
  for (const CLI::App* command : app.get_subcommands({})) {
    const size_t distance = edit_distance(typed, command->get_name());
    if (distance >= least) continue;
    least = distance;
    nearest = command->get_name();
  }
  return "there is no command '" + typed + "'" +
         (nearest.empty() ? "; reeb --help lists them" : "; did you mean '" + nearest + "'?");
}

std::string failure_message(const CLI::App* app, const CLI::Error& error) {
  const auto parsed = app->get_subcommands();
  std::string text = error.what();
  std::string more = "reeb --help";
  if (!parsed.empty() && parsed.front()->get_name() == "help") return "reeb: " + text + "\n";
  if (!parsed.empty()) {
    more = "reeb " + parsed.front()->get_name() + " --help";
  } else if (const auto rest = app->remaining(); !rest.empty() && !rest.front().starts_with('-')) {
    return "reeb: " + unknown_command(*app, rest.front()) + "\n";
  } else if (error.get_name() == "RequiredError") {
    text = "a command is missing";
  }
  return "reeb: " + text + "; see " + more + "\n";
}

}  // namespace

void set_up_command_line(CLI::App& app) {
  app.formatter(std::make_shared<WrappedHelp>());
  app.failure_message(failure_message);
  app.require_subcommand(1);
}

void add_help_command(CLI::App& app, int& exit_code) {
  auto* help = app.add_subcommand("help", "Explain a command");
  auto name = std::make_shared<std::string>();
  help->add_option("COMMAND", *name, "Which one; without it, all are listed")->type_name("");
  help->callback([&app, &exit_code, name] {
    const auto found =
        app.get_subcommands([&](const CLI::App* c) { return c->get_name() == *name; });
    if (found.empty() && !name->empty()) throw CLI::ValidationError(unknown_command(app, *name));
    const CLI::App* const subject = found.empty() ? &app : found.front();
    exit_code = print(subject->get_formatter()->make_help(
        subject, found.empty() ? "reeb" : "reeb " + *name, CLI::AppFormatMode::Normal));
  });
}

}  // namespace reeb::tools
