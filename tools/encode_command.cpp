#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"
#include "tools/archive/shape_source.h"
#include "tools/attribute_rules.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/encoding_report.h"
#include "tools/frame_selection.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/io/standard_output.h"
#include "tools/json.h"
#include "tools/metrics.h"
#include "tools/text.h"

namespace reeb::tools {
namespace encode_command {
namespace {

Profile profile_of(const std::string& name) {
  if (name == "fast") return Profile::kFast;
  return name == "thesis" ? Profile::kThesis : Profile::kMain;
}

constexpr uint32_t kStoredSignatures = 3;  // of a sequence, as reeb index has them

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  double kg = 0;
  AbsoluteOrPercent max_error;
  double bpvf = 0;
  double size = 0;
  bool lossless = false;
  bool overwrite = false;
  bool json = false;
  bool allow_gaps = false;
  bool signature = false;
  bool no_report = false;
  bool keep_going = false;
  bool embed = false;
  std::vector<AttributeRule> attributes;
  FrameSelection frames;
  std::optional<double> frame_rate;
  std::optional<double> start_time;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  EncodeOptions encoder;
  ConsoleOptions console;
};

/// What the sequence would take uncompressed: float32 positions, and the faces once per shot, and
/// attributes and files as they are.
uint64_t raw_bytes(const Sequence& sequence) {
  uint64_t bytes = 12 * vertex_frames(sequence);
  for (const Shot& shot : sequence.shots) {
    bytes += 4 * (shot.connectivity.face_sizes.size() + shot.connectivity.corners.size());
    for (const Attribute& a : shot.attributes) bytes += a.values.size();
  }
  for (const Resource& r : sequence.resources) bytes += r.bytes.size();
  return bytes;
}

void choose_target(const Options& o, const Sequence& sequence, EncodeOptions& out) {
  const auto aim = [&](Target target, double value) {
    out.target = target;
    out.target_value = value;
  };
  if (o.kg > 0) aim(Target::kKg, o.kg);
  if (o.max_error.value > 0) {
    aim(Target::kMaxError, o.max_error.of(bounding_diagonal(sequence)));
  }
  if (o.bpvf > 0) aim(Target::kBpvf, o.bpvf);
  if (o.size > 0) aim(Target::kSize, o.size);
  if (o.lossless) out.target = Target::kLossless;
}

/// Rounding to binary32 is part of the largest error.
Status allow_for_rounding(const ReadReport& read, EncodeOptions& out) {
  if (out.target != Target::kMaxError || read.largest_remainder == 0) return {};
  if (out.target_value > read.largest_remainder) {
    out.target_value -= read.largest_remainder;
    return {};
  }
  return Status::invalid("a largest error of " + plain(out.target_value) +
                         " is out of reach: binary32 alone rounds the positions by up to " +
                         plain(read.largest_remainder) +
                         "; subtract an offset from all frames, or allow more");
}

/// Figures against what the files say, where that is more than the sequence holds.
Status count_rounding(const Sequence& sequence, const ReadReport& read,
                      const std::vector<uint8_t>& bytes, EncodeStats& stats) {
  Sequence decoded;
  Status status = decode_sequence(bytes, {}, decoded);
  Comparison comparison;
  if (status.ok()) status = compare_sequences(sequence, decoded, comparison, read.remainders);
  if (!status.ok()) return status;
  stats.kg = comparison.overall.kg;
  stats.rmse = comparison.overall.rmse;
  stats.max_error = comparison.overall.max_error;
  return {};
}

/// About what the file will take at least; what is aimed at, where that is a size.
uint64_t likely_bytes(const Options& o, const Sequence& sequence) {
  const auto raw = static_cast<double>(raw_bytes(sequence));
  double bytes = raw / 1000;
  if (o.lossless) bytes = raw / 10;
  if (o.bpvf > 0) bytes = o.bpvf / 8 * static_cast<double>(vertex_frames(sequence));
  if (o.size > 0) bytes = o.size;
  return static_cast<uint64_t>(std::min(bytes, raw));
}

/// Where the target has become impossible to write since `prepare`, the work is kept elsewhere.
Status keep_elsewhere(const std::string& output, std::string_view bytes, const Status& failure) {
  std::error_code failed;
  const auto folder = std::filesystem::temp_directory_path(failed);
  const auto name = std::filesystem::path(output).filename();
  const auto target = folder / (std::to_string(::getpid()) + "-" + name.string());
  OutputSet files(false);
  Status status = failed ? failure : files.prepare({target});
  if (status.ok()) status = files.write(target, bytes);
  if (status.ok()) status = files.commit();
  return status.ok() ? Status::io(failure.message() + "; the file is kept as " + target.string())
                     : failure;
}

Status write_stream(const Options& o, const std::vector<uint8_t>& bytes, OutputSet& files) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Status status = files.write(o.output, text);
  if (status.ok()) status = files.commit();
  if (status.ok() || is_standard_output(o.output)) return status;
  return keep_elsewhere(o.output, text, status);
}

/// "attributes: vt 1.2 kB, vn computed": what the file has, by name.
std::string describe_attributes(const std::vector<uint8_t>& bytes) {
  std::unique_ptr<Decoder> decoder;
  if (!Decoder::open(bytes, {}, decoder).ok()) return {};
  struct Part {
    uint64_t bytes = 0;
    bool computed = false;
  };
  std::vector<std::pair<std::string, Part>> parts;
  const auto add = [&](const std::string& name, uint64_t size, bool computed) {
    auto at = std::find_if(parts.begin(), parts.end(),
                           [&](const auto& part) { return part.first == name; });
    if (at == parts.end()) at = parts.insert(at, {name, {}});
    at->second.bytes += size;
    at->second.computed = at->second.computed || computed;
  };
  for (const auto& a : decoder->info().attributes) add(a.header.name, a.bytes, a.header.computed());
  for (const auto& r : decoder->info().resources) add(r.header.name, r.bytes, false);
  std::string out;
  for (const auto& [name, part] : parts)
    out += (out.empty() ? "attributes: " : ", ") + name + (part.computed ? " computed " : " ") +
           byte_size(part.bytes);
  return out;
}

/// Gives the exit code.
int report(const Options& o, const Sequence& sequence, const ReadReport& read,
           const std::vector<uint8_t>& bytes, const EncodeStats& stats, Console& console) {
  const double diagonal = bounding_diagonal(sequence);
  const double relative = diagonal > 0 ? 100 * stats.max_error / diagonal : 0;
  const double ratio = static_cast<double>(raw_bytes(sequence)) / static_cast<double>(stats.bytes);
  console.say(o.output + ": " + byte_size(stats.bytes) + ", " + plain(stats.bpvf) +
              " bits per vertex and frame, " + plain(ratio, 3) + " times smaller than float32");
  if (o.lossless) {
    console.say(read.largest_remainder == 0
                    ? "lossless: every position is kept to the bit"
                    : "lossless: every position is kept to the bit as binary32 holds it, that is "
                      "with an error of up to " +
                          plain(stats.max_error));
  }
  if (!o.lossless)
    console.say("error: KG " + plain(stats.kg) + " %, RMSE " + plain(stats.rmse) + ", maximum " +
                plain(stats.max_error) + " (" + plain(relative) + " % of the diagonal)");
  if (const std::string kept = describe_attributes(bytes); !kept.empty()) console.say(kept);
  for (const EncodeStats::Section& s : stats.sections) {
    console.detail("  " + s.name + ": " + byte_size(static_cast<uint64_t>(s.bits / 8)));
  }
  if (!o.json) return kExitDone;
  Json json{{"file", o.output},
            {"bytes", stats.bytes},
            {"bpvf", stats.bpvf},
            {"kg", stats.kg},
            {"rmse", stats.rmse},
            {"max_error", stats.max_error},
            {"max_error_percent_of_diagonal", relative},
            {"ratio", ratio},
            {"sections", Json::object()},
            {"notes", stats.notes}};
  for (const EncodeStats::Section& s : stats.sections) json["sections"][s.name] = s.bits / 8;
  return print(dump(json), console);
}

std::string wrong_usage(const Options& o) {
  if (o.json && is_standard_output(o.output)) {
    return "--json and -o - both want standard output; name an output file";
  }
  if (o.encoder.open_groups > 0 && o.encoder.profile != Profile::kMain) {
    return "--open-groups needs --profile main: groups of the others are always closed";
  }
  return check_extension(o.output, ".reeb");
}

/// What is asked for of what there is.
Status choose_frames(const Options& o, ReadReport& read, Sequence& sequence) {
  if (o.frame_rate) sequence.frame_rate = *o.frame_rate;
  if (o.start_time) sequence.start_time = *o.start_time;
  if (o.frames.empty()) return {};
  if (!read.missing.empty())
    return Status::invalid("--frames needs a sequence that is whole; decode and name its files");
  std::vector<uint32_t> numbers;
  Status status = o.frames.numbers(sequence.frame_count(), numbers);
  if (!status.ok()) return status;
  read.remainders = pick_remainders(sequence, read.remainders, numbers);
  sequence = pick_frames(sequence, numbers);
  return {};
}

void keep_signature(Sequence& sequence, Console& console) {
  std::string complaint;
  const std::vector<SignedFrame> frames = sign_frames(sequence, kStoredSignatures, complaint);
  if (frames.empty())
    console.say(complaint + "; no signature is kept");
  else
    sequence.metadata[kSignatureKey] = stored_signatures(frames);
}

int run(Options& o) {
  Console console(o.console);
  if (const std::string wrong = wrong_usage(o); !wrong.empty()) {
    console.error(wrong);
    return kExitUsage;
  }
  OutputSet files(o.overwrite);
  Status status = refuse_terminal(o.output, o.overwrite);
  if (status.ok()) status = files.prepare({o.output});
  Sequence sequence;
  ReadReport read;
  const ReadOptions reading{.threads = o.threads,
                            .max_memory = o.max_memory,
                            .allow_gaps = o.allow_gaps,
                            .list_order = o.lossless && !o.encoder.reorder,
                            .embed = o.embed,
                            .progress = console.bar("reading")};
  if (status.ok()) status = read_sequence(o.inputs, reading, sequence, read);
  if (!status.ok()) return fail(console, status);
  console.say_all(read.notes);
  status = choose_frames(o, read, sequence);
  console.say_all(apply_attribute_rules(o.attributes, o.lossless, sequence));
  if (status.ok()) status = check_room(o.output, likely_bytes(o, sequence));
  if (!status.ok()) return fail(console, status);
  console.detail(counted(sequence.frame_count(), "frame") + " of " +
                 counted(sequence.shots[0].connectivity.vertex_count, "vertex") + " read");

  if (o.signature) keep_signature(sequence, console);
  choose_target(o, sequence, o.encoder);
  const EncodingReport aim = aim_of(o.encoder);
  sequence.metadata.erase(kReportKey);  // of what the input was decoded from
  if (!o.no_report) reserve_report(aim, sequence.metadata);
  o.encoder.bounds = !o.no_report;
  if (status = allow_for_rounding(read, o.encoder); !status.ok()) return fail(console, status);
  o.encoder.threads = o.threads;
  if (const auto bar = console.bar("encoding")) {
    o.encoder.progress = [bar](double done) {
      bar(done);
      return true;
    };
  }
  std::vector<uint8_t> bytes;
  EncodeStats stats;
  status = encode(sequence, o.encoder, bytes, stats);
  if (status.ok() && o.encoder.progress) o.encoder.progress(1);
  const bool order_kept = !o.encoder.reorder;  // else there is nothing to compare with
  if (status.ok() && read.largest_remainder > 0 && order_kept) {
    status = count_rounding(sequence, read, bytes, stats);
  }
  if (status.ok() && !o.no_report)
    status = keep_report(aim, static_cast<double>(vertex_frames(sequence)), bytes, stats);
  if (status.ok()) status = write_stream(o, bytes, files);
  if (!status.ok()) return fail(console, status);
  console.say_all(stats.notes);
  return std::max(report(o, sequence, read, bytes, stats, console),
                  finish_damaged(console, describe_damage(o.inputs.back(), read), o.keep_going));
}

void add_target_options(CLI::App& command, Options& o) {
  const std::string group = "Target (one of them; default --kg 0.05)";
  std::vector<CLI::Option*> targets;
  targets.push_back(command.add_option("--kg", o.kg, "KG error in percent, > 0")
                        ->check(check_positive)
                        ->type_name("P"));
  targets.push_back(command
                        .add_option_function<std::string>(
                            "--max-error",
                            [&o](const std::string& text) {
                              const std::string bad = parse_absolute_or_percent(text, o.max_error);
                              if (!bad.empty()) throw CLI::ValidationError("--max-error", bad);
                            },
                            "Largest error of any coordinate, > 0, in units of the input, or as "
                            "E% of the bounding-box diagonal of the sequence")
                        ->type_name("E"));
  targets.push_back(command.add_option("--bpvf", o.bpvf, "Bits per vertex and frame, > 0")
                        ->check(check_positive)
                        ->type_name("R"));
  targets.push_back(command
                        .add_option_function<std::string>(
                            "--size",
                            [&o](const std::string& text) {
                              const std::string bad = parse_byte_count(text, o.size);
                              if (!bad.empty()) throw CLI::ValidationError("--size", bad);
                            },
                            "Bytes of the file, not exceeded; suffixes k, M, G, KiB, MiB, GiB")
                        ->type_name("BYTES"));
  targets.push_back(command.add_flag("--lossless", o.lossless,
                                     "Keep every bit of every position, and the order of faces"));
  for (size_t i = 0; i < targets.size(); ++i) {
    targets[i]->group(group);
    for (size_t j = 0; j < i; ++j) targets[i]->excludes(targets[j]);
  }
}

void add_coding_options(CLI::App& command, Options& o) {
  const std::string group = "Coding";
  command
      .add_option(
          "--group-length", o.encoder.group_length,
          "Frames of a group, which decodes alone: 1 to 65536; default chosen by the encoder")
      ->check(CLI::Range(1u, 65536u).description(""))
      ->type_name("N")
      ->group(group);
  command
      .add_option("--effort", o.encoder.effort,
                  "1 (quickest) to 9 (smallest): encoding time traded for rate; lossless, 1 to 3 "
                  "also decode "
                  "about four times as quick; default 5")
      ->check(CLI::Range(kMinEffort, kMaxEffort).description(""))
      ->type_name("N")
      ->group(group);
  command
      .add_option(
          "--open-groups", o.encoder.open_groups,
          "Groups in a row, 0 to 63, that may continue the group before: smaller, but a seek "
          "decodes the whole run; main profile only; default chosen with the length of groups, 0 "
          "where that is given")
      ->excludes("--lossless")
      ->check(CLI::Range(0, static_cast<int>(kMaxOpenGroups)).description(""))
      ->type_name("N")
      ->group(group);
  command
      .add_flag("--reorder", o.encoder.reorder,
                "Do not keep the order of vertices and lists of the input (smaller)")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--profile", [&o](const std::string& name) { o.encoder.profile = profile_of(name); },
          "main is the smallest, fast decodes quicker, thesis is Hachani's chain, for comparison; "
          "default main")
      ->excludes("--lossless")
      ->check(CLI::IsMember({"main", "fast", "thesis"}).description(""))
      ->type_name("main|fast|thesis")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--regions",
          [&o](const std::string& text) {
            if (text == "auto") return;
            if (!CLI::detail::lexical_cast(text, o.encoder.regions) || o.encoder.regions < 0) {
              throw CLI::ValidationError("--regions", "'" + text + "' is neither auto nor >= 0");
            }
          },
          "Regions of the motion model, 0 = none; default auto (by rate and distortion; where it "
          "rarely pays, in the main profile or on a mesh in one piece, tried at effort 9 only)")
      ->excludes("--lossless")
      ->type_name("N")
      ->group(group);
}

}  // namespace
}  // namespace encode_command

void add_encode_command(CLI::App& app, int& exit_code) {
  using namespace encode_command;
  auto* command = app.add_subcommand("encode", "Compress a sequence into a .reeb file");
  auto o = std::make_shared<Options>();
  command
      ->add_option("INPUT", o->inputs,
                   "A folder or a pattern (walk/*.obj, f_%04d.ply), ordered by the numbers in the "
                   "names; mesh files in the order given; a mesh and a point cache (.pc2, .mdd); "
                   "or a .reeb file; - = a .reeb stream on standard input")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", o->output, "The .reeb file; - = standard output")
      ->required()
      ->type_name("FILE");
  command->add_flag("-f,--force", o->overwrite, "Overwrite an existing file; its permissions stay");
  command->add_flag("--allow-gaps", o->allow_gaps, "Missing frame numbers are not an error");
  add_frames_option(*command, o->frames, "all");
  add_keep_going_option(*command, o->keep_going);
  command->add_flag("--json", o->json, "Report as JSON on standard output");
  add_target_options(*command, *o);
  add_coding_options(*command, *o);
  add_attribute_option(*command, o->attributes);
  command
      ->add_flag(
          "--embed", o->embed,
          "Take along the material files (.mtl) that an OBJ names, and their textures, as far "
          "as they are in its folder or below it")
      ->group("Attributes");
  command->add_option("--fps", o->frame_rate, "Frames per second, > 0; default as in the input")
      ->check(check_positive)
      ->type_name("R")
      ->group("Time");
  command->add_option("--start", o->start_time, "Time of the first frame, in frames")
      ->type_name("T")
      ->group("Time");
  command->add_flag("--signature", o->signature,
                    "Keep what the shape is recognised by, some 8 kB, so that reeb index does not "
                    "decode the file");
  command->add_flag(
      "--no-report", o->no_report,
      "Keep neither target and measured errors nor the boxes that groups lie in, some "
      "90 bytes and 24 a group, which reeb info tells and players use");
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
