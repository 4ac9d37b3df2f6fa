#include <algorithm>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>

#include "tools/attribute_metrics.h"
#include "tools/attribute_rules.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/frame_selection.h"
#include "tools/io/read_sequence.h"
#include "tools/json.h"
#include "tools/metrics.h"
#include "tools/text.h"

namespace reeb::tools {
namespace compare_command {
namespace {

struct Options {
  std::vector<std::string> inputs;
  FrameSelection frames;
  std::optional<double> kg_tolerance;
  std::optional<AbsoluteOrPercent> error_tolerance;
  std::vector<std::pair<std::string, double>> attribute_tolerances;  ///< pattern, figure
  bool json = false;
  bool per_frame = false;
  bool allow_gaps = false;
  bool keep_going = false;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

/// One side of the comparison.
struct Side {
  std::string name;
  Sequence sequence;
  ReadReport report;
  uint32_t total_frames = 0;      ///< missing ones included
  std::vector<uint32_t> present;  ///< numbers, from 1, of the frames that are there
  double units = 0;               ///< vertices times frames of all of them

  /// 0 where the side is not a `.reeb` file.
  double bpvf() const {
    return report.stream ? 8 * static_cast<double>(report.stream->file_bytes) / units : 0;
  }
  bool reordered() const {
    if (!report.stream) return false;
    for (const auto& shot : report.stream->shots) {
      if (!shot.order_kept) return true;
    }
    return false;
  }
  bool has(uint32_t number) const {
    return std::binary_search(present.begin(), present.end(), number);
  }
  std::string damage() const { return describe_damage(name, report); }

  /// Keeps the frames called `numbers`, all of which are there.
  void keep(const std::vector<uint32_t>& numbers) {
    if (numbers == present) return;
    std::vector<uint32_t> places;
    for (const uint32_t number : numbers) {
      const auto at = std::lower_bound(present.begin(), present.end(), number);
      places.push_back(static_cast<uint32_t>(at - present.begin()) + 1);
    }
    report.remainders = pick_remainders(sequence, report.remainders, places);
    sequence = pick_frames(sequence, places);
  }
};

Status load(const Options& o, const std::vector<std::string>& names, Console& console, Side& side) {
  side.name = names.back();
  Status status = read_sequence(names,
                                {.threads = o.threads,
                                 .max_memory = o.max_memory,
                                 .allow_gaps = o.allow_gaps,
                                 .progress = console.bar("reading")},
                                side.sequence, side.report);
  if (!status.ok()) return status;
  console.say_all(side.report.notes);
  side.units = static_cast<double>(vertex_frames(side.sequence));
  side.total_frames =
      side.report.stream ? side.report.stream->total_frames : side.sequence.frame_count();
  side.present = present_frames(side.report.missing, side.total_frames);
  return {};
}

/// Leaves in both sides the frames that were asked for and that both have.
Status choose_frames(const Options& o, Side& a, Side& b, std::vector<uint32_t>& numbers) {
  if (a.total_frames != b.total_frames) {
    return Status::invalid(grouped(a.total_frames) + " against " +
                           counted(b.total_frames, "frame") +
                           "; only sequences of equal length can be compared");
  }
  if (Status status = o.frames.numbers(a.total_frames, numbers); !status.ok()) return status;
  std::erase_if(numbers, [&](uint32_t frame) { return !a.has(frame) || !b.has(frame); });
  if (numbers.empty()) return Status::corrupt("no frame can be decoded on both sides");
  a.keep(numbers);
  b.keep(numbers);
  return {};
}

/// What is to be told.
struct Result {
  const Side& a;
  const Side& b;
  const Comparison& comparison;
  const std::vector<AttributeComparison>& attributes;
  const std::vector<uint32_t>& numbers;  ///< of the frames compared
};

Json to_json(const ErrorFigures& f) {
  return {{"kg", f.kg}, {"rmse", f.rmse}, {"max_error", f.max_error}};
}

Json to_json(const Result& r, const AttributeComparison& a) {
  Json json{{"name", a.name}, {"identical", a.identical}};
  if (!a.problem.empty()) json["problem"] = a.problem;
  json["elements"] = a.compared;
  json["different"] = a.different;
  if (a.whole) return json;
  json["max_error"] = a.max_error;
  if (a.semantic == Semantic::kNormal) json["max_angle"] = a.worst;
  json["worst_frame"] = r.numbers[a.worst_frame];
  return json;
}

std::string attribute_text(const Result& r, const AttributeComparison& a) {
  if (!a.problem.empty()) return a.problem;
  if (a.identical) return "identical";
  if (a.whole) return grouped(a.different) + " of " + grouped(a.compared) + " differ";
  std::string out;
  if (a.semantic == Semantic::kNormal) {
    out = "largest angle " + plain(a.worst, 5) + " degrees";
  } else {
    out = "maximum error";
    for (const double error : a.max_error) out += " " + plain(error, 5);
  }
  return out + ", frame " + grouped(r.numbers[a.worst_frame]);
}

std::string json_text(const Options& o, const Result& r, bool within) {
  const Comparison& c = r.comparison;
  Json json = to_json(c.overall);
  json["max_error_percent_of_diagonal"] = 100 * c.relative_max_error();
  json["diagonal"] = c.diagonal;
  json["max_error_frame"] = r.numbers[c.max_frame];
  json["max_error_vertex"] = c.max_vertex + 1;
  json["identical"] = c.identical;
  json["frames"] = c.frames.size();
  json["within_tolerance"] = within;
  const auto add_side = [&](const char* key, const Side& side) {
    json[key] = {{"name", side.name}};
    if (!side.report.stream) return;
    json[key]["bytes"] = side.report.stream->file_bytes;
    json[key]["bpvf"] = side.bpvf();
  };
  add_side("original", r.a);
  add_side("other", r.b);
  json["attributes"] = Json::array();
  for (const AttributeComparison& a : r.attributes) json["attributes"].push_back(to_json(r, a));
  if (o.per_frame) {
    json["per_frame"] = Json::array();
    for (const ErrorFigures& f : c.frames) json["per_frame"].push_back(to_json(f));
  }
  return dump(json);
}

std::string plain_text(const Options& o, const Result& r) {
  const Comparison& c = r.comparison;
  std::ostringstream out;
  if (o.per_frame) {
    const auto row = [&](const std::string& frame, const std::string& kg, const std::string& rmse,
                         const std::string& most) {
      out << std::setw(8) << frame << std::setw(13) << kg << std::setw(13) << rmse << std::setw(13)
          << most << "\n";
    };
    row("frame", "KG %", "RMSE", "maximum");
    for (size_t t = 0; t < c.frames.size(); ++t) {
      const ErrorFigures& f = c.frames[t];
      row(grouped(r.numbers[t]), plain(f.kg, 5), plain(f.rmse, 5), plain(f.max_error, 5));
    }
  }
  out << "KG error       " << plain(c.overall.kg, 5) << " %\n"
      << "RMSE           " << plain(c.overall.rmse, 5) << "\n"
      << "maximum error  " << plain(c.overall.max_error, 5) << " ("
      << plain(100 * c.relative_max_error(), 5) << " % of the diagonal), frame "
      << grouped(r.numbers[c.max_frame]) << ", vertex " << grouped(c.max_vertex + 1) << "\n";
  for (const Side* side : {&r.a, &r.b}) {
    if (!side->report.stream) continue;
    out << side->name << ": " << byte_size(side->report.stream->file_bytes) << ", "
        << plain(side->bpvf(), 5) << " bits per vertex and frame\n";
  }
  if (c.identical) out << "the positions are identical\n";
  for (const AttributeComparison& a : r.attributes)
    out << "attribute " << a.name << ": " << attribute_text(r, a) << "\n";
  return out.str();
}

// What exceeds the tolerances; empty where nothing does.
std::string excess(const Options& o, const Comparison& c) {
  std::string out;
  if (o.kg_tolerance && !(c.overall.kg <= *o.kg_tolerance)) {
    out = "KG error " + plain(c.overall.kg, 6) + " % is over " + plain(*o.kg_tolerance, 6) + " %";
  }
  if (o.error_tolerance) {
    const double limit = o.error_tolerance->of(c.diagonal);
    if (!(c.overall.max_error <= limit)) {
      out += (out.empty() ? "" : "; ") + std::string("maximum error ") +
             plain(c.overall.max_error, 6) + " is over " + plain(limit, 6);
    }
  }
  return out;
}

/// The same of attributes. What was not compared is over every tolerance.
std::string excess(const Options& o, const std::vector<AttributeComparison>& attributes) {
  std::string out;
  for (const AttributeComparison& a : attributes) {
    for (const auto& [pattern, limit] : o.attribute_tolerances) {
      if (!fits_pattern(a.name, pattern) || a.figure() <= limit) continue;
      out += (out.empty() ? "" : "; ") + ("attribute " + a.name) + " is over " + plain(limit, 6) +
             ": " + (a.problem.empty() ? plain(a.figure(), 6) : a.problem);
      break;
    }
  }
  return out;
}

std::string parse_tolerance(const std::string& text, std::pair<std::string, double>& out) {
  const size_t equals = text.rfind('=');
  const bool good = equals != text.npos && equals > 0 &&
                    CLI::detail::lexical_cast(text.substr(equals + 1), out.second) &&
                    out.second >= 0;
  if (!good) return "'" + text + "' is not NAME=TOLERANCE, >= 0";
  out.first = text.substr(0, equals);
  return {};
}

int report_difference(const Side& a, const Side& b, const Status& status, Console& console) {
  console.error(a.name + " against " + b.name + ": " + status.message());
  if (a.reordered() != b.reordered()) {
    console.error("one side was encoded with --reorder, its vertices are in another order");
  }
  return kExitFailed;
}

int run(const Options& o) {
  Console console(o.console);
  const auto sides = split_sequences(o.inputs, 2);
  if (sides.size() != 2) {
    console.error("two sequences are compared, each by one name, or a mesh and its point cache");
    return kExitUsage;
  }
  Side a;
  Side b;
  Status status = load(o, sides[0], console, a);
  if (status.ok()) status = load(o, sides[1], console, b);
  if (!status.ok()) return fail(console, status);
  std::vector<uint32_t> numbers;
  Comparison comparison;
  status = choose_frames(o, a, b, numbers);
  if (status.ok()) {
    status = compare_sequences(a.sequence, b.sequence, comparison, a.report.remainders,
                               b.report.remainders);
  }
  if (!status.ok()) return report_difference(a, b, status, console);
  const std::vector<AttributeComparison> attributes = compare_attributes(a.sequence, b.sequence);
  std::string over = excess(o, comparison);
  if (const std::string more = excess(o, attributes); !more.empty())
    over += (over.empty() ? "" : "; ") + more;
  const Result result{a, b, comparison, attributes, numbers};
  int exit_code =
      print(o.json ? json_text(o, result, over.empty()) : plain_text(o, result), console);
  for (const Side* side : {&a, &b})
    exit_code = std::max(exit_code, finish_damaged(console, side->damage(), o.keep_going));
  if (over.empty() || exit_code != kExitDone) return exit_code;
  console.error(over);
  return kExitOverTolerance;
}

}  // namespace
}  // namespace compare_command

void add_compare_command(CLI::App& app, int& exit_code) {
  using namespace compare_command;
  auto* command = app.add_subcommand("compare", "Measure how far one sequence is from another");
  auto o = std::make_shared<Options>();
  command
      ->add_option("SEQUENCE", o->inputs,
                   "The original and the other one, each a folder, a quoted pattern, a .reeb file, "
                   "or a point cache with its mesh beside it or named before it")
      ->required()
      ->expected(2, 4)
      ->type_name("");
  command->add_flag("--json", o->json, "As JSON");
  command->add_flag("--per-frame", o->per_frame, "Figures of every frame too");
  add_frames_option(*command, o->frames, "all");
  add_keep_going_option(*command, o->keep_going);
  command->add_flag("--allow-gaps", o->allow_gaps, "Missing frame numbers are not an error");
  command->add_option("--tolerance", o->kg_tolerance, "KG error allowed, in percent, >= 0")
      ->check(check_not_negative)
      ->type_name("P")
      ->group("Tolerance (exit code 3 beyond)");
  command
      ->add_option_function<std::string>(
          "--max-error",
          [o](const std::string& text) {
            const std::string bad = parse_absolute_or_percent(text, o->error_tolerance.emplace());
            if (!bad.empty()) throw CLI::ValidationError("--max-error", bad);
          },
          "Error of a coordinate allowed, > 0, in units of the original, or as E% of the "
          "bounding-box diagonal of its sequence")
      ->type_name("E")
      ->group("Tolerance (exit code 3 beyond)");
  command
      ->add_option_function<std::vector<std::string>>(
          "--attribute",
          [o](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::string bad = parse_tolerance(text, o->attribute_tolerances.emplace_back());
              if (!bad.empty()) throw CLI::ValidationError("--attribute", bad);
            }
          },
          "What is allowed of an attribute, or of those that a pattern like 'v*' names, >= 0: the "
          "largest error of a channel; of normals the largest angle in degrees; of whole numbers "
          "and names how many differ. One that only one side has is over any. May be given several "
          "times")
      ->allow_extra_args(false)
      ->type_name("NAME=E")
      ->group("Tolerance (exit code 3 beyond)");
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
