#include <algorithm>
#include <memory>
#include <set>

#include "bitstream/container.h"
#include "codec/dec/decoder.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/frame_selection.h"
#include "tools/io/file_bytes.h"
#include "tools/io/point_cache.h"
#include "tools/io/read_sequence.h"
#include "tools/io/standard_output.h"
#include "tools/io/write_sequence.h"
#include "tools/text.h"

namespace reeb::tools {
namespace decode_command {
namespace {

struct Options {
  std::string input;
  std::string output;
  std::string format;
  FrameSelection frames;
  std::optional<double> frame_rate;
  bool reverse = false;
  bool overwrite = false;
  bool keep_going = false;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

/// Writes the frames of one stream.
class StreamWriter {
 public:
  StreamWriter(const Options& options, Decoder& decoder, Console& console)
      : options_(options), decoder_(decoder), console_(console), missing_(decoder.info().missing) {}

  int run() {
    const StreamInfo& info = decoder_.info();
    Status status = options_.frames.numbers(info.total_frames, wanted_);
    if (!status.ok()) return fail(console_, named(status));
    if (options_.reverse) std::reverse(wanted_.begin(), wanted_.end());
    OutputName name;
    status = parse_output_name(options_.output, static_cast<uint32_t>(wanted_.size()),
                               options_.format, name);
    if (!status.ok()) {
      console_.error(status.message());
      return kExitUsage;
    }
    if (name.extension != ".obj" && name.extension != ".off")
      status = refuse_terminal(options_.output, options_.overwrite);
    if (status.ok()) status = write_present();
    if (status.code() == StatusCode::kCorrupt && !searched_) status = write_after_search();
    if (!status.ok()) return fail(console_, status);
    console_.say_all(notes_);
    console_.say(options_.output + ": " + counted(written_, "frame"));
    const bool complete = written_ == wanted_.size();
    const std::string damage = describe_damage(
        options_.input, decoder_.info(), complete ? std::vector<StreamInfo::Gap>() : missing_);
    const int exit_code = finish_damaged(console_, damage, options_.keep_going);
    return std::max(exit_code, finish_damaged(console_, lost_text(), options_.keep_going));
  }

 private:
  Status named(const Status& status) const {
    return stream_failure(options_.input, status, options_.max_memory);
  }
  std::string missing_text() const {
    return describe_missing(options_.input, missing_, decoder_.info().total_frames);
  }

  std::string lost_text() const {
    std::string names;
    for (const std::string& name : lost_) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "" : options_.input + ": damaged and left out: " + names;
  }

  // Damage that checksums do not show is met while decoding: then all of it is looked for.
  Status write_after_search() {
    searched_ = true;
    Status status = find_missing(decoder_, console_.bar("checking"), missing_);
    return status.ok() ? write_present() : named(status);
  }

  Status write_present() {
    const std::vector<uint32_t> present = present_frames(missing_, decoder_.info().total_frames);
    std::vector<uint32_t> frames;
    for (const uint32_t frame : wanted_) {
      if (std::binary_search(present.begin(), present.end(), frame)) frames.push_back(frame);
    }
    if (frames.empty()) return Status::corrupt(missing_text());
    written_ = frames.size();
    notes_.clear();
    lost_.clear();
    return write_sequence(make_source(frames), options_.output,
                          {.format = options_.format,
                           .overwrite = options_.overwrite,
                           .threads = options_.threads,
                           .progress = console_.bar("decoding"),
                           .notes = &notes_});
  }

  Status decode(uint32_t frame, SourceFrame& out) {
    Status status = decoder_.connectivity(frame, out.connectivity);
    if (!status.ok()) return status;
    out.positions.resize(size_t{3} * out.connectivity->vertex_count);
    status = decoder_.decode_frame(frame, out.positions.data());
    return status.ok() ? decode_attributes(frame, out.attributes) : status;
  }

  // Those that are damaged are left out, which is said in the end.
  Status decode_attributes(uint32_t frame, std::vector<Attribute>& out) {
    std::vector<Attribute> described;
    std::vector<uint32_t> indices;
    out.clear();
    if (Status status = decoder_.attributes(frame, described, indices); !status.ok()) return status;
    for (size_t i = 0; i < indices.size(); ++i) {
      Status status = decoder_.decode_attribute(frame, indices[i], out.emplace_back());
      if (status.ok()) continue;
      if (status.code() != StatusCode::kCorrupt) return status;
      out.pop_back();
      lost_.insert(described[i].name);
    }
    return {};
  }

  FrameSource make_source(const std::vector<uint32_t>& frames) {
    const StreamInfo& info = decoder_.info();
    FrameSource source;
    source.frame_rate = options_.frame_rate.value_or(info.frame_rate);
    // What is not in order is a new sequence, with numbers and times from its own start.
    const bool in_order = ascending(frames);
    source.start_time = info.start_time + (in_order ? frames.front() - 1 : 0);
    for (uint32_t i = 0; i < frames.size(); ++i) {
      source.numbers.push_back(in_order ? frames[i] : i + 1);
    }
    for (const auto& [key, value] : info.metadata) {
      if (key == kSampleRateKey) source.frames_per_sample = std::strtod(value.c_str(), nullptr);
    }
    source.least_bytes = position_bytes(frames);
    for (uint32_t i = 0; i < info.resources.size(); ++i) {
      Resource resource;
      const Status status = decoder_.resource(i, resource);
      if (status.ok())
        source.resources.push_back(std::move(resource));
      else
        lost_.insert(info.resources[i].header.name);
    }
    source.frame = [this, frames](uint32_t i, SourceFrame& out) {
      const Status status = decode(frames[i] - 1, out);
      return status.ok() ? status : named(status);
    };
    return source;
  }

  uint64_t position_bytes(const std::vector<uint32_t>& frames) const {
    uint64_t bytes = 0;
    for (const auto& shot : decoder_.info().shots) {
      const auto inside = [&](uint32_t frame) {
        return frame > shot.first_frame && frame <= shot.first_frame + shot.frame_count;
      };
      bytes += 12 * uint64_t{shot.vertex_count} *
               static_cast<uint64_t>(std::count_if(frames.begin(), frames.end(), inside));
    }
    return bytes;
  }

  const Options& options_;
  Decoder& decoder_;
  Console& console_;
  std::vector<StreamInfo::Gap> missing_;
  std::vector<uint32_t> wanted_;  ///< from 1
  size_t written_ = 0;
  std::set<std::string> lost_;  ///< attributes and files that are damaged
  std::vector<std::string> notes_;
  bool searched_ = false;
};

int run(const Options& o) {
  Console console(o.console);
  FileBytes file;
  Status status = FileBytes::read(o.input, file);
  if (!status.ok()) return fail(console, status);
  const std::string_view text = file.view();
  std::unique_ptr<Decoder> decoder;
  DecodeOptions options{.limits = {}, .threads = o.threads};
  options.limits.max_memory = o.max_memory;
  status =
      Decoder::open({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, options, decoder);
  if (!status.ok()) return fail(console, stream_failure(o.input, status, o.max_memory));
  return StreamWriter(o, *decoder, console).run();
}

}  // namespace
}  // namespace decode_command

void add_decode_command(CLI::App& app, int& exit_code) {
  using namespace decode_command;
  auto* command =
      app.add_subcommand("decode", "Write frames of a .reeb file as meshes or point cache");
  auto o = std::make_shared<Options>();
  command->add_option("INPUT", o->input, "The .reeb file; - = standard input")
      ->required()
      ->type_name("");
  command
      ->add_option("-o,--output", o->output,
                   "By its name: out/f_%04d.obj (.ply, .off, .stl) a file per frame; out.pc2 or "
                   "out.mdd a point cache, with out.obj; a folder; out.obj for one frame; - = "
                   "standard output")
      ->required()
      ->type_name("NAME");
  command
      ->add_option("--format", o->format,
                   "Of a folder's files or of standard output; default obj, for several frames to "
                   "standard output pc2")
      ->check(CLI::IsMember({"obj", "ply", "off", "stl", "pc2", "mdd"}).description(""))
      ->type_name("obj|ply|off|stl|pc2|mdd");
  command->add_flag("-f,--force", o->overwrite, "Overwrite existing files; their permissions stay");
  add_frames_option(*command, o->frames, "all");
  command->add_flag("--reverse", o->reverse, "Last frame first");
  command
      ->add_option("--fps", o->frame_rate,
                   "Frames per second of an .mdd, > 0; default as in the .reeb file")
      ->check(check_positive)
      ->type_name("R");
  add_keep_going_option(*command, o->keep_going);
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
