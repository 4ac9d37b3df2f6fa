#include <charconv>
#include <memory>

#include "codec/dec/decoder.h"
#include "tools/command.h"
#include "tools/io/file_bytes.h"
#include "tools/io/point_cache.h"
#include "tools/io/write_sequence.h"
#include "tools/text.h"

namespace reeb::tools {
namespace decode_command {
namespace {

/// Frames from 1, as typed; 0 = an end left open.
struct FrameRange {
  uint32_t first = 0;
  uint32_t last = 0;
};

struct Options {
  std::string input;
  std::string output;
  FrameRange range;
  bool reverse = false;
  bool overwrite = false;
  unsigned threads = 0;
  ConsoleOptions console;
};

// A frame number, or 0 for nothing.
bool parse_frame(std::string_view text, uint32_t& frame) {
  frame = 0;
  if (text.empty()) return true;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  return error == std::errc() && stop == text.data() + text.size() && frame > 0;
}

bool parse_range(const std::string& text, FrameRange& range) {
  const size_t colon = text.find(':');
  const std::string_view view(text);
  if (!parse_frame(view.substr(0, colon), range.first)) return false;
  if (colon == text.npos) {
    range.last = range.first;
    return range.first != 0;
  }
  return parse_frame(view.substr(colon + 1), range.last);
}

// The numbers of the frames to decode, in order of output.
Status select_frames(const FrameRange& range, bool reverse, uint32_t count,
                     std::vector<uint32_t>& out) {
  uint32_t a = range.first == 0 ? 1 : range.first;
  uint32_t b = range.last == 0 ? count : range.last;
  if (a > count || b > count) {
    return Status::invalid("frame " + grouped(std::max(a, b)) +
                           " does not exist; there are frames 1 to " + grouped(count));
  }
  if (reverse) std::swap(a, b);
  for (uint32_t t = a;; a < b ? ++t : --t) {
    out.push_back(t);
    if (t == b) return {};
  }
}

FrameSource make_source(Decoder& decoder, const std::vector<uint32_t>& frames) {
  const StreamInfo& info = decoder.info();
  FrameSource source;
  source.frame_rate = info.frame_rate;
  const bool forward = frames.front() <= frames.back();
  // A reversed sequence is a new one, with numbers and times from its own start.
  source.start_time = info.start_time + (forward ? frames.front() - 1 : 0);
  for (uint32_t i = 0; i < frames.size(); ++i) {
    source.numbers.push_back(forward ? frames[i] : i + 1);
  }
  for (const auto& [key, value] : info.metadata) {
    if (key == kSampleRateKey) source.frames_per_sample = std::strtod(value.c_str(), nullptr);
  }
  source.frame = [&decoder, frames](uint32_t i, const Connectivity*& connectivity,
                                    std::vector<float>& positions) {
    const uint32_t frame = frames[i] - 1;
    if (Status status = decoder.connectivity(frame, connectivity); !status.ok()) return status;
    positions.resize(size_t{3} * connectivity->vertex_count);
    return decoder.decode_frame(frame, positions.data());
  };
  return source;
}

int run(const Options& o) {
  Console console(o.console);
  FileBytes file;
  Status status = FileBytes::read(o.input, file);
  if (!status.ok()) return fail(console, status);
  const std::string_view text = file.view();
  std::unique_ptr<Decoder> decoder;
  status = Decoder::open({reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                         {.limits = {}, .threads = o.threads}, decoder);
  if (!status.ok()) return fail(console, {status.code(), o.input + ": " + status.message()});
  if (decoder->info().truncated) {
    console.say(o.input + ": truncated; " + counted(decoder->info().frame_count, "frame") +
                " before the cut can be decoded");
  }
  std::vector<uint32_t> frames;
  status = select_frames(o.range, o.reverse, decoder->info().frame_count, frames);
  if (!status.ok()) return fail(console, {status.code(), o.input + ": " + status.message()});

  OutputName name;
  status = parse_output_name(o.output, static_cast<uint32_t>(frames.size()), name);
  if (!status.ok()) {
    console.error(status.message());
    return kExitUsage;
  }
  status = write_sequence(
      make_source(*decoder, frames), o.output,
      {.overwrite = o.overwrite, .threads = o.threads, .progress = console.bar("decoding")});
  if (!status.ok()) return fail(console, status);
  console.say(o.output + ": " + counted(frames.size(), "frame"));
  return kExitDone;
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
                   "out.mdd a point cache, with out.obj; a folder; out.obj for one frame")
      ->required()
      ->type_name("NAME");
  command->add_flag("-f,--force", o->overwrite, "Overwrite existing files");
  command
      ->add_option_function<std::string>(
          "--frames",
          [o](const std::string& text) {
            if (parse_range(text, o->range)) return;
            throw CLI::ValidationError("--frames", "'" + text + "' is not a frame or range from 1");
          },
          "First and last frame, from 1: 10:20, 10:, :20, one frame 7, backwards 20:10; default "
          "all")
      ->type_name("A:B");
  command->add_flag("--reverse", o->reverse, "Last frame first");
  add_threads_option(*command, o->threads);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
