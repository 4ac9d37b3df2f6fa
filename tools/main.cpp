// The `reeb` command.
#include "tools/archive_command.h"
#include "tools/command.h"
#include "tools/interrupt.h"
#include "tools/segment_command.h"
#include "tools/version.h"

int main(int argc, char** argv) {
  using namespace reeb::tools;
  remove_output_on_interrupt();
  CLI::App app("Codec for animated triangle meshes. reeb COMMAND --help explains a command.",
               "reeb");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 comparison over tolerance, 130 interrupted");

  int exit_code = kExitDone;
  add_encode_command(app, exit_code);
  add_decode_command(app, exit_code);
  add_info_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_sample_command(app, exit_code);
  add_picture_command(app, exit_code);
  add_plot_command(app, exit_code);
  add_segment_command(app, exit_code);
  add_index_command(app, exit_code);
  add_search_command(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitDone : kExitUsage;
  } catch (const std::bad_alloc&) {
    Console({}).error("out of memory; close other programs or encode a shorter sequence");
    return kExitFailed;
  }
  return exit_code;
}
