#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/command.h"
#include "tools/io/read_sequence.h"
#include "tools/metrics.h"
#include "tools/text.h"

namespace reeb::tools {
namespace compare_command {
namespace {

struct Options {
  std::string original;
  std::string other;
  std::optional<double> kg_tolerance;
  std::optional<AbsoluteOrPercent> error_tolerance;
  bool json = false;
  bool per_frame = false;
  bool allow_gaps = false;
  unsigned threads = 0;
  ConsoleOptions console;
};

/// One side of the comparison.
struct Side {
  std::string name;
  Sequence sequence;
  ReadReport report;

  /// 0 where the side is not a `.reeb` file.
  double bpvf() const {
    if (!report.stream) return 0;
    return 8 * static_cast<double>(report.stream->file_bytes) /
           static_cast<double>(vertex_frames(sequence));
  }
  bool reordered() const {
    if (!report.stream) return false;
    for (const auto& shot : report.stream->shots) {
      if (!shot.order_kept) return true;
    }
    return false;
  }
};

Status load(const Options& o, const std::string& name, Console& console, Side& side) {
  side.name = name;
  Status status = read_sequence(
      {name},
      {.threads = o.threads, .allow_gaps = o.allow_gaps, .progress = console.bar("reading")},
      side.sequence, side.report);
  if (status.ok()) console.say_all(side.report.notes);
  return status;
}

nlohmann::ordered_json to_json(const ErrorFigures& f) {
  return {{"kg", f.kg}, {"rmse", f.rmse}, {"max_error", f.max_error}};
}

void print_json(const Options& o, const Side& a, const Side& b, const Comparison& c, bool within) {
  nlohmann::ordered_json json = to_json(c.overall);
  json["max_error_percent_of_diagonal"] = 100 * c.relative_max_error();
  json["diagonal"] = c.diagonal;
  json["max_error_frame"] = c.max_frame + 1;
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
  add_side("original", a);
  add_side("other", b);
  if (o.per_frame) {
    json["per_frame"] = nlohmann::ordered_json::array();
    for (const ErrorFigures& f : c.frames) json["per_frame"].push_back(to_json(f));
  }
  std::cout << json.dump(2) << "\n";
}

void print_text(const Options& o, const Side& a, const Side& b, const Comparison& c) {
  if (o.per_frame) {
    std::printf("%8s %12s %12s %12s\n", "frame", "KG %", "RMSE", "maximum");
    for (size_t t = 0; t < c.frames.size(); ++t) {
      const ErrorFigures& f = c.frames[t];
      std::printf("%8zu %12.5g %12.5g %12.5g\n", t + 1, f.kg, f.rmse, f.max_error);
    }
  }
  std::printf("KG error       %s %%\n", brief(c.overall.kg, 5).c_str());
  std::printf("RMSE           %s\n", brief(c.overall.rmse, 5).c_str());
  std::printf("maximum error  %s (%s %% of the diagonal), frame %s, vertex %s\n",
              brief(c.overall.max_error, 5).c_str(), brief(100 * c.relative_max_error(), 5).c_str(),
              grouped(c.max_frame + 1).c_str(), grouped(c.max_vertex + 1).c_str());
  for (const Side* side : {&a, &b}) {
    if (!side->report.stream) continue;
    std::printf("%s: %s, %s bits per vertex and frame\n", side->name.c_str(),
                byte_size(side->report.stream->file_bytes).c_str(), brief(side->bpvf(), 5).c_str());
  }
  if (c.identical) std::printf("the positions are identical\n");
}

// What exceeds the tolerances; empty where nothing does.
std::string excess(const Options& o, const Comparison& c) {
  std::string out;
  if (o.kg_tolerance && !(c.overall.kg <= *o.kg_tolerance)) {
    out = "KG error " + brief(c.overall.kg, 6) + " % is over " + brief(*o.kg_tolerance, 6) + " %";
  }
  if (o.error_tolerance) {
    const double limit = o.error_tolerance->of(c.diagonal);
    if (!(c.overall.max_error <= limit)) {
      out += (out.empty() ? "" : "; ") + std::string("maximum error ") +
             brief(c.overall.max_error, 6) + " is over " + brief(limit, 6);
    }
  }
  return out;
}

int run(const Options& o) {
  Console console(o.console);
  Side a;
  Side b;
  Status status = load(o, o.original, console, a);
  if (status.ok()) status = load(o, o.other, console, b);
  if (!status.ok()) return fail(console, status);
  Comparison comparison;
  status = compare_sequences(a.sequence, b.sequence, comparison, a.report.remainders,
                             b.report.remainders);
  if (!status.ok()) {
    console.error(a.name + " against " + b.name + ": " + status.message());
    if (a.reordered() != b.reordered()) {
      console.error("one side was encoded with --reorder, its vertices are in another order");
    }
    return kExitFailed;
  }
  const std::string over = excess(o, comparison);
  if (o.json) {
    print_json(o, a, b, comparison, over.empty());
  } else {
    print_text(o, a, b, comparison);
  }
  if (over.empty()) return kExitDone;
  console.error(over);
  return kExitOverTolerance;
}

}  // namespace
}  // namespace compare_command

void add_compare_command(CLI::App& app, int& exit_code) {
  using namespace compare_command;
  auto* command = app.add_subcommand("compare", "Measure how far one sequence is from another");
  auto o = std::make_shared<Options>();
  const std::string sequence =
      ": a folder, a quoted pattern, a point cache with its mesh beside it, "
      "or a .reeb file";
  command->add_option("ORIGINAL", o->original, "The original" + sequence)
      ->required()
      ->type_name("");
  command->add_option("OTHER", o->other, "The other sequence, likewise")->required()->type_name("");
  command->add_flag("--json", o->json, "As JSON");
  command->add_flag("--per-frame", o->per_frame, "Figures of every frame too");
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
  add_threads_option(*command, o->threads);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
