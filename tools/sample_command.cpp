#include <memory>

#include "tools/command.h"
#include "tools/io/write_sequence.h"
#include "tools/sample/sample.h"
#include "tools/text.h"

namespace reeb::tools {
namespace sample_command {
namespace {

struct Options {
  std::string name;
  std::string output;
  uint32_t frame_count = 100;
  bool attributes = false;
  bool overwrite = false;
  unsigned threads = 0;
  ConsoleOptions console;
};

int run(const Options& o) {
  Console console(o.console);
  Sequence sequence;
  OutputName name;
  Status status = parse_output_name(o.output, o.frame_count, "", name);
  if (status.ok()) status = make_sample(o.name, o.frame_count, sequence, o.attributes);
  if (!status.ok()) {
    console.error(status.message());
    return kExitUsage;
  }
  std::vector<std::string> notes;
  status = write_sequence(source_of(sequence), o.output,
                          {.overwrite = o.overwrite,
                           .threads = o.threads,
                           .progress = console.bar("writing"),
                           .notes = &notes});
  if (!status.ok()) return fail(console, status);
  console.say_all(notes);
  console.say(o.output + ": " + counted(sequence.frame_count(), "frame") + " of " +
              counted(sequence.shots[0].connectivity.vertex_count, "vertex"));
  return kExitDone;
}

}  // namespace
}  // namespace sample_command

void add_sample_command(CLI::App& app, int& exit_code) {
  using namespace sample_command;
  auto* command = app.add_subcommand("sample", "Make an animated sequence from nothing");
  auto o = std::make_shared<Options>();
  std::string names = "One of:";
  for (const SampleInfo& s : samples()) names += std::string("\n") + s.name + ": " + s.description;
  names += "\n" + figure_description();
  command->add_option("NAME", o->name, names)->required()->type_name("");
  command
      ->add_option(
          "-o,--output", o->output,
          "A folder, or by its name: out/f_%04d.obj (.ply, .off, .stl), out.pc2 or out.mdd")
      ->required()
      ->type_name("NAME");
  command->add_option("--length", o->frame_count, "Number of frames, 1 to 100000; default 100")
      ->check(CLI::Range(1u, 100000u).description(""))
      ->type_name("N");
  command->add_flag("--attributes", o->attributes,
                    "Texture coordinates, normals and materials of the creature, stretch of the "
                    "sheet (.ply), groups and colours of the mechanism, too");
  command->add_flag("-f,--force", o->overwrite, "Overwrite existing files; their permissions stay");
  add_threads_option(*command, o->threads);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
