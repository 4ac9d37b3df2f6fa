// The `reeb` command.
#include <csignal>
#include <exception>
#include <filesystem>
#include <iterator>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "tools/archive_command.h"
#include "tools/command.h"
#include "tools/command_line.h"
#include "tools/interrupt.h"
#include "tools/segment_command.h"
#include "tools/version.h"

namespace {

using namespace reeb::tools;

// What follows the program's name, last one first as CLI11 takes it. It would take "[a]" apart as a
// list, though a folder may be named so.
std::vector<std::string> arguments(int argc, char** argv) {
  std::vector<std::string> out(std::make_reverse_iterator(argv + argc),
                               std::make_reverse_iterator(argv + 1));
  for (std::string& a : out) {
    std::error_code ignored;
    if (a.starts_with('[') && a.ends_with(']') && std::filesystem::exists(a, ignored))
      a.insert(0, "./");
  }
  return out;
}

int run(int argc, char** argv) {
  remove_output_on_interrupt();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is a failed write, which is told
  CLI::App app("Codec for animated triangle meshes. reeb COMMAND --help explains a command.",
               "reeb");
  app.set_version_flag("--version", version_text());
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 comparison over tolerance, 129 hung up, "
      "130 interrupted, 143 terminated");
  set_up_command_line(app);

  int exit_code = kExitDone;
  add_encode_command(app, exit_code);
  add_decode_command(app, exit_code);
  add_info_command(app, exit_code);
  add_verify_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_sample_command(app, exit_code);
  add_picture_command(app, exit_code);
  add_plot_command(app, exit_code);
  add_view_command(app, exit_code);
  add_segment_command(app, exit_code);
  add_index_command(app, exit_code);
  add_search_command(app, exit_code);
  add_help_command(app, exit_code);

  try {
    app.parse(arguments(argc, argv));
  } catch (const CLI::ParseError& error) {
    std::ostringstream help;
    return app.exit(error, help) == 0 ? print(help.str()) : kExitUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    Console({}).error("out of memory; close other programs or encode a shorter sequence");
  } catch (const std::exception& error) {
    Console({}).error(std::string("this should not happen, please report it: ") + error.what());
  }
  return kExitFailed;
}
