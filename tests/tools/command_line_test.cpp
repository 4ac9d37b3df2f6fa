// Help, wrong usage, signals: what is around every command.
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "tests/tools/run_command.h"
#include "tools/command.h"
#include "tools/terminal.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using Catch::StartsWith;

size_t longest_line(const std::string& text) {
  std::istringstream lines(text);
  size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

CommandResult run_in_columns(const std::vector<std::string>& arguments, const char* columns) {
  return run_reeb(arguments, "/dev/null", [=] { ::setenv("COLUMNS", columns, 1); });
}

/// Starts a command that writes many files, and waits until it is in the middle of them.
pid_t start_long_command(const TempFolder& folder, const std::function<void()>& prepare = {}) {
  const pid_t child = start_reeb(
      {"sample", "mechanism", "--length", "4000", "-T", "1", "-o", folder / "a/f_%d.obj"},
      "/dev/null", "/dev/null", "/dev/null", prepare);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (folder.names().size() < 5 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  REQUIRE(folder.names().size() >= 5);
  return child;
}

}  // namespace

TEST_CASE("a misspelt command is named with the nearest one") {
  CHECK(run_reeb({"encdoe"}).err == "reeb: there is no command 'encdoe'; did you mean 'encode'?\n");
  CHECK_THAT(run_reeb({"comprae", "a", "b"}).err, Contains("did you mean 'compare'?"));
  CHECK_THAT(run_reeb({"help", "inof"}).err, Contains("did you mean 'info'?"));
  CHECK(run_reeb({"frobnicate"}).err ==
        "reeb: there is no command 'frobnicate'; reeb --help lists them\n");
}

TEST_CASE("every usage error begins with the program and names the help") {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{}, "reeb --help"},
      {{"--frob"}, "reeb --help"},
      {{"encode"}, "reeb encode --help"},
      {{"encode", "a.obj", "-o", "a.reeb", "--frob"}, "reeb encode --help"},
      {{"encode", "a.obj", "-o", "a.reeb", "--kg"}, "reeb encode --help"},
      {{"picture", "a.obj", "-o", "a.png", "--tile", "3"}, "reeb picture --help"},
      {{"help", "inof"}, "info"}};
  for (const auto& [arguments, hint] : wrong) {
    const CommandResult result = run_reeb(arguments);
    INFO(result.err);
    CHECK(result.exit_code == kExitUsage);
    CHECK_THAT(result.err, StartsWith("reeb: ") && Contains(hint));
    CHECK(result.out.empty());
  }
}

TEST_CASE("help of a command comes either way") {
  const CommandResult help = run_reeb({"help", "encode"});
  CHECK(help.exit_code == kExitDone);
  CHECK(help.out == run_reeb({"encode", "--help"}).out);
  CHECK(run_reeb({"help"}).out == run_reeb({"--help"}).out);
}

TEST_CASE("help wraps at the terminal's width") {
  for (const char* command : {"encode", "decode", "compare", "segment", "picture", "sample"}) {
    INFO(command);
    for (const char* columns : {"50", "80", "120"}) {
      const CommandResult help = run_in_columns({command, "--help"}, columns);
      CHECK(longest_line(help.out) <= std::stoul(columns));
    }
    CHECK(longest_line(run_in_columns({command, "--help"}, "120").out) > 80);
  }
  CHECK(longest_line(run_in_columns({"--help"}, "60").out) <= 60);
  CHECK(longest_line(run_reeb({"--help"}).out) <= 80);
}

TEST_CASE("text wraps between words") {
  CHECK(wrapped("one two three", 7) == "one two\nthree");
  CHECK(wrapped("one two three", 6) == "one\ntwo\nthree");
  CHECK(wrapped("incomprehensible a b", 5) == "incomprehensible\na b");
  CHECK(wrapped("a\nb c", 80) == "a\nb c");
  CHECK(wrapped("", 80).empty());
}

TEST_CASE("what standard output does not take is an error") {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"--version"}, {"encode", "--help"}, {"help"}}) {
    const TempFolder folder;
    CHECK(exit_code_of(start_reeb(arguments, "/dev/null", "/dev/full", folder / "err")) ==
          kExitFailed);
    CHECK_THAT(read_text(folder / "err"),
               StartsWith("reeb: standard output: cannot be written (No space left"));
  }
}

TEST_CASE("an interrupted command leaves nothing and tells the signal") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TempFolder folder;
    const pid_t child = start_long_command(folder);
    ::kill(child, signal);
    CHECK(exit_code_of(child) == 128 + signal);
    CHECK(folder.names().empty());
  }
}

TEST_CASE("an ignored signal stays ignored") {
  const TempFolder folder;
  const pid_t child = start_long_command(folder, [] {
    std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGINT, SIG_IGN);
  });
  ::kill(child, SIGHUP);
  ::kill(child, SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ::kill(child, SIGTERM);
  // Either of the others would have come first.
  CHECK(exit_code_of(child) == 128 + SIGTERM);
}

}  // namespace reeb::tools
