#include <algorithm>
#include <memory>

#include "tools/command.h"
#include "tools/damage.h"
#include "tools/frame_selection.h"
#include "tools/io/file_bytes.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/io/standard_output.h"
#include "tools/metrics.h"
#include "tools/picture/contact_sheet.h"
#include "tools/picture/read_image.h"
#include "tools/text.h"

namespace reeb::tools {
namespace picture_command {
namespace {

constexpr uint32_t kDefaultColumns = 4;

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  FrameSelection frames;
  bool keep_going = false;
  int tile = 360;
  double azimuth = 35;
  double elevation = 12;
  bool z_up = false;
  std::string attribute;
  std::string texture;
  bool overwrite = false;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

// Frames from 0: those asked for, or some spread over the sequence.
Status select_frames(const FrameSelection& asked, uint32_t count, std::vector<uint32_t>& out) {
  if (!asked.empty()) {
    Status status = asked.numbers(count, out);
    for (uint32_t& frame : out) --frame;
    return status;
  }
  out = spread_frames(count, kDefaultColumns);
  return {};
}

Status load(const Options& o, const std::vector<std::string>& names, Console& console,
            Sequence& out, std::string& damage) {
  ReadReport report;
  Status status = read_sequence(
      names, {.threads = o.threads, .max_memory = o.max_memory, .progress = console.bar("reading")},
      out, report);
  if (!status.ok()) return status;
  console.say_all(report.notes);
  damage = describe_damage(names.back(), report);
  return {};
}

/// A file, or what the sequence carries under that name.
Status load_texture(const std::string& name, const Sequence& sequence, Image& out) {
  const auto carried = std::find_if(sequence.resources.begin(), sequence.resources.end(),
                                    [&](const Resource& r) { return r.name == name; });
  FileBytes file;
  std::string_view bytes;
  if (carried != sequence.resources.end()) {
    bytes = {reinterpret_cast<const char*>(carried->bytes.data()), carried->bytes.size()};
  } else {
    if (Status status = FileBytes::read(name, file); !status.ok()) return status;
    bytes = file.view();
  }
  const Status status = decode_image(bytes, out);
  return status.ok() ? status : Status(status.code(), name + ": " + status.message());
}

/// What covers the mesh.
Status choose_paint(const Options& o, const Sequence& sequence, Console& console, Image& texture,
                    SheetOptions& sheet) {
  if (!o.attribute.empty()) {
    sheet.attribute = o.attribute;
    if (Status status = find_scale(sequence, o.attribute, sheet.scale); !status.ok()) return status;
    if (sheet.scale.used)
      console.say(o.attribute + ": from " + plain(sheet.scale.low) + " in blue to " +
                  plain(sheet.scale.high) + " in red");
  }
  if (o.texture.empty()) return {};
  for (const Shot& shot : sequence.shots) {
    if (texture_coordinates(shot, 0).empty())
      return Status::invalid("there are no texture coordinates for " + o.texture);
  }
  sheet.texture = &texture;
  return load_texture(o.texture, sequence, texture);
}

int run(const Options& o) {
  Console console(o.console);
  const auto inputs = split_sequences(o.inputs, 1);
  std::string wrong = check_extension(o.output, ".png");
  if (inputs.size() > 2) wrong = "a picture shows two sequences at most";
  if (!wrong.empty()) {
    console.error(wrong);
    return kExitUsage;
  }
  OutputSet files(o.overwrite);
  Status status = refuse_terminal(o.output, o.overwrite);
  if (status.ok()) status = files.prepare({o.output});
  Sequence original;
  Sequence other;
  std::string damage, other_damage;
  if (status.ok()) status = load(o, inputs[0], console, original, damage);
  if (status.ok() && inputs.size() == 2) {
    status = load(o, inputs[1], console, other, other_damage);
    Comparison comparison;
    if (status.ok()) status = compare_sequences(original, other, comparison);
  }
  SheetOptions sheet;
  Image texture(1, 1);
  if (status.ok()) status = select_frames(o.frames, original.frame_count(), sheet.frames);
  if (status.ok()) status = choose_paint(o, original, console, texture, sheet);
  if (!status.ok()) return fail(console, status);

  sheet.tile_width = o.tile;
  sheet.tile_height = o.tile * 5 / 6;
  sheet.camera = Camera::orbit(o.azimuth, o.elevation, o.z_up);
  std::string png;
  status = encode_png(contact_sheet(original, inputs.size() == 1 ? nullptr : &other, sheet), png);
  if (status.ok()) status = files.write(o.output, png);
  if (status.ok()) status = files.commit();
  if (!status.ok()) return fail(console, status);
  console.say(o.output + ": " + counted(sheet.frames.size(), "frame"));
  return std::max(finish_damaged(console, damage, o.keep_going),
                  finish_damaged(console, other_damage, o.keep_going));
}

}  // namespace
}  // namespace picture_command

void add_picture_command(CLI::App& app, int& exit_code) {
  using namespace picture_command;
  auto* command = app.add_subcommand("picture", "Draw frames side by side into a PNG");
  auto o = std::make_shared<Options>();
  command
      ->add_option("SEQUENCE", o->inputs,
                   "A folder, a quoted pattern, a .reeb file, or a point cache with its mesh "
                   "beside it or named before it; and a decoded one to show under it, with the "
                   "error in colour")
      ->required()
      ->expected(1, 4)
      ->type_name("");
  command->add_option("-o,--output", o->output, "The PNG file")->required()->type_name("FILE");
  command->add_flag("-f,--force", o->overwrite, "Overwrite an existing file; its permissions stay");
  add_frames_option(*command, o->frames, "four");
  add_keep_going_option(*command, o->keep_going);
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
  auto* attribute =
      command
          ->add_option("--attribute", o->attribute,
                       "Coloured by an attribute: colours as they are, whole numbers each in one, "
                       "others from blue to red")
          ->type_name("NAME")
          ->group(group);
  command
      ->add_option("--texture", o->texture,
                   "Covered with a picture (PNG, JPEG, BMP, TGA), a file or one that the .reeb "
                   "file carries, by its texture coordinates")
      ->excludes(attribute)
      ->type_name("FILE")
      ->group(group);
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
