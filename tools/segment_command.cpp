#include "tools/segment_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "codec/common/mesh/faces.h"
#include "segmentation/motion.h"
#include "segmentation/skeleton.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/frame_selection.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/picture/contact_sheet.h"
#include "tools/segment_files.h"
#include "tools/segment_picture.h"
#include "tools/text.h"

namespace reeb::tools {
namespace segment_command {
namespace {

constexpr uint32_t kDefaultColumns = 4;

struct Options {
  std::vector<std::string> inputs;
  std::string mesh, graph, picture;
  uint32_t regions = 0;
  FrameSelection frames;
  bool keep_going = false;
  int tile = 400;
  double azimuth = 35;
  double elevation = 12;
  bool z_up = false;
  bool overwrite = false;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

/// The segmentation of the first shot and everything that is made of it.
class Segmented {
 public:
  Segmented(const Shot& shot, const Options& options)
      : shot_(shot),
        triangles_(fan_triangles(shot.connectivity)),
        result_(segmentation::segment(shot.frame(0), triangles_)),
        skeleton_(result_, shot.frame(0), triangles_),
        labels_(result_.labels) {
    if (options.regions > 0) follow_motion(options.regions);
  }

  const segmentation::Result& result() const { return result_; }
  std::string summary() const {
    const auto& graph = result_.graph;
    const size_t extremities = result_.feature_points.size();
    return grouped(extremities) + (extremities == 1 ? " extremity, " : " extremities, ") +
           counted(graph.arcs.size(), "arc") + ", " + counted(graph.loops(), "loop") + ", " +
           counted(region_count(), "region") + ", motion error " +
           plain(segmentation::motion_error(input(), labels_)) + " %";
  }

  std::string mesh() const { return coloured_ply(shot_.connectivity, shot_.frame(0), labels_); }

  std::string graph(bool as_obj) const {
    if (as_obj) return graph_obj(result_.graph, skeleton_.place(shot_.frame(0)));
    std::vector<segmentation::SkeletonPose> poses;
    for (uint32_t t = 0; t < shot_.frame_count; ++t)
      poses.push_back(skeleton_.place(shot_.frame(t)));
    return graph_json(result_, poses);
  }

  Status picture(const Options& o, std::string& png) const {
    std::vector<uint32_t> shown = spread_frames(shot_.frame_count, kDefaultColumns);
    if (!o.frames.empty()) {
      if (Status status = o.frames.numbers(shot_.frame_count, shown); !status.ok()) return status;
      for (uint32_t& frame : shown) --frame;
    }
    std::vector<PictureFrame> frames;
    frames.reserve(shown.size());
    for (const uint32_t t : shown) {
      frames.push_back({t, shot_.frame(t), skeleton_.place(shot_.frame(t))});
    }
    const PictureSubject subject{&shot_.connectivity, labels_, &result_.graph};
    const Camera camera = Camera::orbit(o.azimuth, o.elevation, o.z_up);
    return encode_png(segment_picture(subject, frames, camera, o.tile), png);
  }

 private:
  segmentation::MotionInput input() const { return {shot_.frame(0), triangles_, shot_.positions}; }

  uint32_t region_count() const {
    return labels_.empty() ? 0 : *std::max_element(labels_.begin(), labels_.end()) + 1;
  }

  void follow_motion(uint32_t regions) {
    const segmentation::MotionPartitions partitions(input(), result_);
    if (partitions.finest() == 0) return;
    labels_ = segmentation::adjust_borders(
        input(), partitions.labels(std::min(regions, partitions.finest())));
  }

  const Shot& shot_;
  std::vector<uint32_t> triangles_;
  segmentation::Result result_;
  segmentation::Skeleton skeleton_;
  std::vector<uint32_t> labels_;
};

bool has_extension(const std::string& name, const char* extension) {
  return check_extension(name, extension).empty();
}

std::vector<std::filesystem::path> targets(const Options& o) {
  std::vector<std::filesystem::path> out;
  for (const std::string& name : {o.mesh, o.graph, o.picture}) {
    if (!name.empty()) out.emplace_back(name);
  }
  return out;
}

Status write_all(const Options& o, const Segmented& segmented, OutputSet& output) {
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  if (!o.mesh.empty()) files.emplace_back(o.mesh, segmented.mesh());
  if (!o.graph.empty())
    files.emplace_back(o.graph, segmented.graph(has_extension(o.graph, ".obj")));
  if (!o.picture.empty()) {
    std::string png;
    if (Status status = segmented.picture(o, png); !status.ok()) return status;
    files.emplace_back(o.picture, std::move(png));
  }
  Status status;
  for (const auto& [name, bytes] : files) {
    if (status.ok()) status = output.write(name, bytes);
  }
  return status.ok() ? output.commit() : status;
}

std::string wrong_usage(const Options& o) {
  if (o.mesh.empty() && o.graph.empty() && o.picture.empty()) {
    return "nothing to write; give -o, --graph or --png";
  }
  if (!o.mesh.empty() && !has_extension(o.mesh, ".ply")) return o.mesh + " does not end in .ply";
  if (!o.graph.empty() && !has_extension(o.graph, ".obj") && !has_extension(o.graph, ".json")) {
    return o.graph + " does not end in .obj or .json";
  }
  if (!o.picture.empty() && !has_extension(o.picture, ".png")) {
    return o.picture + " does not end in .png";
  }
  return {};
}

int run(const Options& o) {
  Console console(o.console);
  if (const std::string wrong = wrong_usage(o); !wrong.empty()) {
    console.error(wrong);
    return kExitUsage;
  }
  OutputSet output(o.overwrite);
  Status status = output.prepare(targets(o));
  Sequence sequence;
  ReadReport report;
  const ReadOptions reading{
      .threads = o.threads, .max_memory = o.max_memory, .progress = console.bar("reading")};
  if (status.ok()) status = read_sequence(o.inputs, reading, sequence, report);
  if (!status.ok()) return fail(console, status);
  console.say_all(report.notes);
  if (sequence.shots.size() > 1) console.say("only the frames of the first faces are segmented");
  const Segmented segmented(sequence.shots.front(), o);
  console.say_all(segmented.result().warnings);
  status = write_all(o, segmented, output);
  if (!status.ok()) return fail(console, status);
  console.say(segmented.summary());
  return finish_damaged(console, describe_damage(o.inputs.back(), report), o.keep_going);
}

void add_picture_options(CLI::App& command, Options& o) {
  const std::string group = "Picture";
  add_frames_option(command, o.frames, "four")->group(group);
  command.add_option("--tile", o.tile, "Width of a frame in pixels, 16 to 4096; default 400")
      ->check(CLI::Range(16, 4096).description(""))
      ->type_name("N")
      ->group(group);
  command
      .add_option("--azimuth", o.azimuth,
                  "Degrees about the upright axis; 0 = from the front (+z), 90 = from +x; "
                  "default 35")
      ->type_name("A")
      ->group(group);
  command.add_option("--elevation", o.elevation, "Degrees above the ground; default 12")
      ->type_name("A")
      ->group(group);
  command.add_flag("--z-up", o.z_up, "z is upright, not y")->group(group);
}

}  // namespace
}  // namespace segment_command

void add_segment_command(CLI::App& app, int& exit_code) {
  using namespace segment_command;
  auto* command =
      app.add_subcommand("segment", "Show the regions and the Reeb graph of a sequence");
  auto o = std::make_shared<Options>();
  command
      ->add_option("INPUT", o->inputs,
                   "A folder, files, a quoted pattern, a point cache with its mesh beside it, or a "
                   ".reeb file")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", o->mesh, "First frame coloured by region, a .ply file")
      ->type_name("FILE");
  command
      ->add_option("--graph", o->graph,
                   "The graph: .obj with the skeleton of the first frame, or .json with all "
                   "attributes and the skeleton of every frame")
      ->type_name("FILE");
  command
      ->add_option("--png", o->picture,
                   "A picture of several frames, regions numbered and the graph inside")
      ->type_name("FILE");
  command
      ->add_option(
          "--regions", o->regions,
          "Cut and merge by motion into this many regions, 1 to 2000; default: one per arc "
          "and branching of the graph")
      ->check(CLI::Range(1u, 2000u).description(""))
      ->type_name("N");
  command->add_flag("-f,--force", o->overwrite, "Overwrite existing files; their permissions stay");
  add_keep_going_option(*command, o->keep_going);
  add_picture_options(*command, *o);
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
