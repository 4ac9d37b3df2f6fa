#include <memory>

#include "tools/command.h"
#include "tools/io/file_bytes.h"
#include "tools/io/output_set.h"
#include "tools/picture/plot.h"
#include "tools/text.h"

namespace reeb::tools {
namespace plot_command {
namespace {

constexpr const char* kSeries[] = {"sequence", "configuration", "codec"};

struct Options {
  std::string input;
  std::string output;
  std::string x = "bpvf";
  std::string y = "kg";
  std::vector<std::string> series;  ///< empty: those of kSeries that the table has
  bool overwrite = false;
  PlotOptions plot;
  ConsoleOptions console;
};

Status draw(const Options& o, const std::string& csv, std::string& svg) {
  CsvTable table;
  std::vector<Curve> curves;
  Status status = parse_csv(csv, table);
  std::vector<std::string> series = o.series;
  for (const char* name : kSeries) {
    if (o.series.empty() && table.find(name) >= 0) series.emplace_back(name);
  }
  if (status.ok()) status = curves_of(table, o.x, o.y, series, curves);
  if (status.ok()) status = plot_svg(curves, o.plot, svg);
  return status;
}

int run(Options& o) {
  Console console(o.console);
  if (const std::string wrong = check_extension(o.output, ".svg"); !wrong.empty()) {
    console.error(wrong);
    return kExitUsage;
  }
  OutputSet files(o.overwrite);
  if (Status status = files.prepare({o.output}); !status.ok()) return fail(console, status);
  FileBytes file;
  Status status = FileBytes::read(o.input, file);
  if (!status.ok()) return fail(console, status);
  if (o.plot.x_label.empty()) o.plot.x_label = o.x == "bpvf" ? "bits per vertex and frame" : o.x;
  if (o.plot.y_label.empty()) o.plot.y_label = o.y == "kg" ? "KG error, percent" : o.y;
  std::string svg;
  status = draw(o, std::string(file.view()), svg);
  if (!status.ok()) return fail(console, {status.code(), o.input + ": " + status.message()});
  status = files.write(o.output, svg);
  if (status.ok()) status = files.commit();
  return status.ok() ? kExitDone : fail(console, status);
}

}  // namespace
}  // namespace plot_command

void add_plot_command(CLI::App& app, int& exit_code) {
  using namespace plot_command;
  auto* command =
      app.add_subcommand("plot", "Draw rate-distortion curves from a table into an SVG");
  auto o = std::make_shared<Options>();
  command
      ->add_option("TABLE", o->input,
                   "Comma-separated values with a header line; - = standard input")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", o->output, "The SVG file")->required()->type_name("FILE");
  command->add_flag("-f,--force", o->overwrite, "Overwrite an existing file; its permissions stay");
  const std::string group = "Columns";
  command->add_option("-x", o->x, "Column along; default bpvf")->type_name("COLUMN")->group(group);
  command->add_option("-y", o->y, "Column upwards; default kg")->type_name("COLUMN")->group(group);
  command
      ->add_option(
          "--series", o->series,
          "Columns whose values tell curves apart, as in sequence,codec; default: those of "
          "sequence, configuration and codec that there are")
      ->delimiter(',')
      ->type_name("COLUMNS")
      ->group(group);
  const std::string look = "Look";
  command->add_option("--title", o->plot.title, "Words above")->type_name("TEXT")->group(look);
  command->add_option("--x-label", o->plot.x_label, "Words below")->type_name("TEXT")->group(look);
  command->add_option("--y-label", o->plot.y_label, "Words at the left")
      ->type_name("TEXT")
      ->group(look);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
