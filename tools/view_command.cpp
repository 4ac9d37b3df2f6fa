#include <fcntl.h>
#include <spawn.h>

#include <memory>

#include "tools/command.h"
#include "tools/page_server.h"

extern "C" char** environ;

namespace reeb::tools {
namespace view_command {
namespace {

struct Options {
  PageOptions page;
  bool no_open = false;
  ConsoleOptions console;
};

/// By the program that the desktop has for it; what it says is not for this terminal.
void open_in_browser(std::string address) {
  std::string program = "xdg-open";
  char* const words[] = {program.data(), address.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int out : {1, 2})
    posix_spawn_file_actions_addopen(&actions, out, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &actions, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&actions);
}

int run(Options o) {
  Console console(o.console);
  if (o.page.page.empty()) o.page.page = installed_page();
  if (o.page.page.empty()) {
    console.error("the player is not installed; --page FOLDER tells where it is built");
    return kExitFailed;
  }
  const Status status = serve_page(o.page, [&](const std::string& address) {
    console.say("showing " + address + " until Ctrl-C");
    if (!o.no_open) open_in_browser(address);
  });
  return fail(console, status);
}

}  // namespace
}  // namespace view_command

void add_view_command(CLI::App& app, int& exit_code) {
  using namespace view_command;
  auto* command = app.add_subcommand("view", "Show a .reeb file in the browser of this machine");
  auto o = std::make_shared<Options>();
  command->add_option("FILE", o->page.files, "The .reeb file, or two to compare")
      ->required()
      ->expected(1, 2)
      ->type_name("");
  command->add_option("--page", o->page.page, "Folder of the built player; the installed one")
      ->type_name("FOLDER");
  command->add_option("--port", o->page.port, "Port of 127.0.0.1 to listen on; any that is free")
      ->check(CLI::Range(1, 65535))
      ->type_name("N");
  command->add_flag("--no-open", o->no_open, "Only tell the address");
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
