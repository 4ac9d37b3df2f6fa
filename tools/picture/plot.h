// Rate-distortion curves as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y
};

struct PlotOptions {
  std::string title;
  std::string x_label;
  std::string y_label;
  int width = 720;  ///< pixels at least; more where the legend needs it
  int height = 480;
};

/// Curves over logarithmic axes, their points in ascending x. Points that are not positive and
/// finite are left out; fails where none is left.
Status plot_svg(const std::vector<Curve>& curves, const PlotOptions& options, std::string& out);

/// A table with a header line: comma-separated, values in double quotes may hold commas.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`

  /// -1 where there is no such column.
  int find(const std::string& column) const;
};

/// Empty lines and lines that begin with # are skipped. A failure names the line.
Status parse_csv(const std::string& text, CsvTable& out);

/// Points of columns x and y, one curve for each combination of the values in `series` columns, in
/// order of appearance. Rows whose x or y is no number are left out. A failure names what is
/// missing.
Status curves_of(const CsvTable& table, const std::string& x, const std::string& y,
                 const std::vector<std::string>& series, std::vector<Curve>& out);

}  // namespace reeb::tools
