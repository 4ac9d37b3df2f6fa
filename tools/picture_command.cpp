#include <algorithm>
#include <memory>

#include "tools/command.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/metrics.h"
#include "tools/picture/contact_sheet.h"
#include "tools/text.h"

namespace reeb::tools {
namespace picture_command {
namespace {

constexpr uint32_t kDefaultColumns = 4;

struct Options {
  std::string original;
  std::string other;
  std::string output;
  std::vector<uint32_t> frames;
  int tile = 360;
  double azimuth = 35;
  double elevation = 12;
  bool z_up = false;
  bool overwrite = false;
  unsigned threads = 0;
  ConsoleOptions console;
};

// Frames from 0: those asked for, or some spread over the sequence.
Status select_frames(const std::vector<uint32_t>& asked, uint32_t count,
                     std::vector<uint32_t>& out) {
  for (const uint32_t frame : asked) {
    if (frame < 1 || frame > count) {
      return Status::invalid("frame " + grouped(frame) + " does not exist; there are frames 1 to " +
                             grouped(count));
    }
    out.push_back(frame - 1);
  }
  if (asked.empty()) out = spread_frames(count, kDefaultColumns);
  return {};
}

Status load(const Options& o, const std::string& name, Console& console, Sequence& out) {
  ReadReport report;
  const Status status = read_sequence({name}, {.threads = o.threads}, out, report);
  if (status.ok()) console.say_all(report.notes);
  return status;
}

int run(const Options& o) {
  Console console(o.console);
  if (Status status = check_target(o.output, o.overwrite); !status.ok())
    return fail(console, status);
  Sequence original;
  Sequence other;
  Status status = load(o, o.original, console, original);
  if (status.ok() && !o.other.empty()) {
    status = load(o, o.other, console, other);
    Comparison comparison;
    if (status.ok()) status = compare_sequences(original, other, comparison);
  }
  SheetOptions sheet;
  if (status.ok()) status = select_frames(o.frames, original.frame_count(), sheet.frames);
  if (!status.ok()) return fail(console, status);

  sheet.tile_width = o.tile;
  sheet.tile_height = o.tile * 5 / 6;
  sheet.camera = Camera::orbit(o.azimuth, o.elevation, o.z_up);
  std::string png;
  status = encode_png(contact_sheet(original, o.other.empty() ? nullptr : &other, sheet), png);
  OutputSet files(o.overwrite);
  if (status.ok()) status = files.prepare({o.output});
  if (status.ok()) status = files.write(o.output, png);
  if (status.ok()) status = files.commit();
  if (!status.ok()) return fail(console, status);
  console.say(o.output + ": " + counted(sheet.frames.size(), "frame"));
  return kExitDone;
}

}  // namespace
}  // namespace picture_command

void add_picture_command(CLI::App& app, int& exit_code) {
  using namespace picture_command;
  auto* command = app.add_subcommand("picture", "Draw frames side by side into a PNG");
  auto o = std::make_shared<Options>();
  const std::string sequence =
      ": a folder, a quoted pattern, a point cache with its mesh beside it, "
      "or a .reeb file";
  command->add_option("A", o->original, "A sequence" + sequence)->required()->type_name("");
  command->add_option("B", o->other, "A decoded one to show under it, with the error in colour")
      ->type_name("");
  command->add_option("-o,--output", o->output, "The PNG file")->required()->type_name("FILE");
  command->add_flag("-f,--force", o->overwrite, "Overwrite an existing file");
  command->add_option("--frames", o->frames, "Frames to show, from 1, as in 1,20,40; default four")
      ->delimiter(',')
      ->type_name("LIST");
  const std::string group = "View";
  command->add_option("--tile", o->tile, "Width of a frame in pixels, 16 to 4096; default 360")
      ->check(CLI::Range(16, 4096).description(""))
      ->type_name("N")
      ->group(group);
  command
      ->add_option(
          "--azimuth", o->azimuth,
          "Degrees about the upright axis; 0 = from the front (+z), 90 = from +x; default 35")
      ->type_name("A")
      ->group(group);
  command->add_option("--elevation", o->elevation, "Degrees above the ground; default 12")
      ->type_name("A")
      ->group(group);
  command->add_flag("--z-up", o->z_up, "z is upright, not y")->group(group);
  add_threads_option(*command, o->threads);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
