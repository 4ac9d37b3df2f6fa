#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/archive/result_sheet.h"
#include "tools/archive/shape_archive.h"
#include "tools/archive/shape_source.h"
#include "tools/archive_command.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/text.h"

namespace reeb::tools {
namespace search_command {
namespace {

struct Options {
  std::string archive;
  std::string query;
  uint32_t frame = 1;
  uint32_t count = 10;
  std::string by = "all";
  bool json = false;
  std::string picture;
  ResultSheetOptions sheet;
  double azimuth = 35, elevation = 12;
  bool z_up = false;
  bool overwrite = false;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

RankBy rank_by(const std::string& name) {
  if (name == "charts") return RankBy::kCharts;
  if (name == "spectrum") return RankBy::kSpectrum;
  return name == "body" ? RankBy::kBody : RankBy::kAll;
}

// How alike two shapes are, 0 .. 100.
double score(double distance) { return 100 / (1 + distance); }

std::string as_table(const ShapeArchive& archive, const std::vector<SearchResult>& results,
                     RankBy by) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  for (size_t i = 0; i < results.size(); ++i) {
    const ArchivedFile& file = archive.files[results[i].file];
    text << std::setw(4) << i + 1 << std::setw(7) << score(ranked_distance(results[i].distance, by))
         << "  " << file.path;
    if (file.shapes.size() > 1) text << ", frame " << results[i].frame;
    text << "\n";
  }
  return text.str();
}

std::string as_json(const ShapeArchive& archive, const std::vector<SearchResult>& results,
                    RankBy by) {
  auto list = nlohmann::json::array();
  for (const SearchResult& r : results) {
    list.push_back({{"file", archive.files[r.file].path},
                    {"frame", r.frame},
                    {"score", score(ranked_distance(r.distance, by))},
                    {"distance",
                     {{"charts", r.distance.charts},
                      {"spectrum", r.distance.spectrum},
                      {"body", r.distance.body},
                      {"all", r.distance.total}}}});
  }
  return nlohmann::json{{"results", list}}.dump(1) + "\n";
}

Status read_query(const Options& o, Console& console, Sequence& sequence,
                  retrieval::Signature& signature) {
  ReadReport report;
  Status status = read_sequence({o.query}, {.threads = o.threads, .max_memory = o.max_memory},
                                sequence, report);
  if (!status.ok()) return status;
  if (o.frame > sequence.frame_count()) {
    return Status::invalid(o.query + ": there are frames 1 to " + grouped(sequence.frame_count()) +
                           "; choose another --frame");
  }
  const ShapeFrame shape = shape_frame(sequence, o.frame - 1);
  retrieval::Signed result = retrieval::sign(shape.positions, shape.triangles);
  if (result.signature.empty()) return Status::invalid(o.query + ": " + result.warnings.back());
  console.say_all(result.warnings);
  signature = std::move(result.signature);
  return {};
}

Status draw_results(const Options& o, const ShapeArchive& archive, const Sequence& query,
                    const std::vector<SearchResult>& results, Console& console) {
  ResultSheet sheet(o.sheet);
  sheet.add("query", query, o.frame - 1);
  for (const SearchResult& r : results) {
    const std::string& path = archive.files[r.file].path;
    Sequence sequence;
    ReadReport report;
    if (Status status = read_sequence({path}, {.threads = o.threads, .max_memory = o.max_memory},
                                      sequence, report);
        !status.ok()) {
      console.say(status.message() + "; left out of the picture");
      continue;
    }
    const std::string name = std::filesystem::path(path).stem().string();
    sheet.add(brief(score(ranked_distance(r.distance, rank_by(o.by))), 3) + " " + name, sequence,
              r.frame - 1);
  }
  std::string png;
  Status status = encode_png(sheet.image(), png);
  OutputSet output(o.overwrite);
  if (status.ok()) status = output.prepare({o.picture});
  if (status.ok()) status = output.write(o.picture, png);
  return status.ok() ? output.commit() : status;
}

int run(Options& o) {
  Console console(o.console);
  if (!o.picture.empty()) {
    if (Status status = check_target(o.picture, o.overwrite); !status.ok())
      return fail(console, status);
  }
  o.sheet.camera = Camera::orbit(o.azimuth, o.elevation, o.z_up);
  ShapeArchive archive;
  Sequence query;
  retrieval::Signature signature;
  Status status = read_archive(o.archive, archive);
  if (status.ok()) status = read_query(o, console, query, signature);
  if (!status.ok()) return fail(console, status);
  const RankBy by = rank_by(o.by);
  const std::vector<SearchResult> results = search_archive(archive, signature, by, o.count);
  const int exit_code =
      print(o.json ? as_json(archive, results, by) : as_table(archive, results, by), console);
  if (o.picture.empty() || exit_code != kExitDone) return exit_code;
  status = draw_results(o, archive, query, results, console);
  return status.ok() ? kExitDone : fail(console, status);
}

void add_picture_options(CLI::App& command, Options& o) {
  const std::string group = "Picture";
  command.add_option("--png", o.picture, "A picture of the query and what was found")
      ->type_name("FILE")
      ->group(group);
  command.add_flag("-f,--force", o.overwrite, "Overwrite an existing picture")->group(group);
  command.add_option("--tile", o.sheet.tile, "Width of a shape in pixels, 16 to 4096; default 200")
      ->check(CLI::Range(16, 4096).description(""))
      ->type_name("N")
      ->group(group);
  command
      .add_option(
          "--azimuth", o.azimuth,
          "Degrees about the upright axis; 0 = from the front (+z), 90 = from +x; default 35")
      ->type_name("A")
      ->group(group);
  command.add_option("--elevation", o.elevation, "Degrees above the ground; default 12")
      ->type_name("A")
      ->group(group);
  command.add_flag("--z-up", o.z_up, "z is upright, not y")->group(group);
}

}  // namespace
}  // namespace search_command

void add_search_command(CLI::App& app, int& exit_code) {
  using namespace search_command;
  auto* command =
      app.add_subcommand("search", "Find the shapes of an archive that are most like one");
  auto o = std::make_shared<Options>();
  command->add_option("ARCHIVE", o->archive, "Made by reeb index")->required()->type_name("");
  command
      ->add_option("QUERY", o->query,
                   "A mesh or a sequence: a file, a folder, a quoted pattern or a .reeb file")
      ->required()
      ->type_name("");
  command->add_option("--frame", o->frame, "Frame of the query, from 1; default 1")
      ->check(CLI::Range(1u, 0xffffffffu).description(""))
      ->type_name("N");
  command->add_option("-k,--count", o->count, "Files to list, 1 to 100000; default 10")
      ->check(CLI::Range(1u, 100000u).description(""))
      ->type_name("N");
  command
      ->add_option("--by", o->by,
                   "What to compare: all (default); charts, the Reeb charts alone; spectrum, heat "
                   "and waves on the surface; body, thickness, straightness, curvature and reach")
      ->check(CLI::IsMember({"all", "charts", "spectrum", "body"}).description(""))
      ->type_name("PART");
  command->add_flag("--json", o->json, "Results as JSON, with all distances");
  add_picture_options(*command, *o);
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
