#include "tools/picture/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr double kLeft = 70;
constexpr double kTop = 44;
constexpr double kBottom = 56;
constexpr double kLegendLine = 18;
constexpr double kLegendText = 40;    ///< from the end of the axis
constexpr double kLetterWidth = 7.2;  ///< of the legend, more than most take

// Told apart also by those who do not see red and green alike.
constexpr std::array<const char*, 8> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#56b4e9", "#e69f00", "#444444", "#8c6d31"};

bool drawable(const std::pair<double, double>& p) {
  return p.first > 0 && p.second > 0 && std::isfinite(p.first) && std::isfinite(p.second);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

/// A logarithmic axis from `low` to `high` over the pixels from `first` to `last`.
struct Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  double first = 0;
  double last = 1;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void widen() {
    low /= 1.15;
    high *= 1.15;
  }
  double place(double value) const {
    return first + (last - first) * std::log(value / low) / std::log(high / low);
  }
  /// 1, 2, 5 of every power of ten; powers of ten alone over long ranges.
  std::vector<double> ticks() const {
    std::vector<double> out;
    const bool sparse = high / low > 3e3;
    for (int power = -12; power <= 12; ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double value = digit * std::pow(10.0, power);
        if (value >= low && value <= high && (digit == 1.0 || !sparse)) out.push_back(value);
      }
    }
    return out;
  }
};

class Plot {
 public:
  Plot(const std::vector<Curve>& curves, const PlotOptions& options)
      : curves_(curves), options_(options) {}

  Status run(std::string& out) {
    for (const Curve& curve : curves_) {
      for (const auto& p : curve.points) {
        if (!drawable(p)) continue;
        x_.include(p.first);
        y_.include(p.second);
      }
    }
    if (!(x_.high > 0)) return Status::invalid("there is nothing to plot: no positive values");
    x_.widen();
    y_.widen();
    x_.first = kLeft;
    lay_out();
    draw_frame();
    for (size_t i = 0; i < curves_.size(); ++i) draw_curve(i);
    out = std::move(svg_) + "</svg>\n";
    return {};
  }

 private:
  /// The page grows with the legend.
  void lay_out() {
    size_t letters = 0;
    for (const Curve& curve : curves_) letters = std::max(letters, curve.name.size());
    const double legend = kLegendText + kLetterWidth * static_cast<double>(letters);
    width_ = static_cast<int>(std::max(1.0 * options_.width, 2 * kLeft + 2 * legend));
    const double lines = kTop + kLegendLine * static_cast<double>(curves_.size());
    height_ = static_cast<int>(std::max(1.0 * options_.height, lines + kLegendLine));
    x_.last = width_ - legend;
    y_.first = height_ - kBottom;
    y_.last = kTop;
  }

  void draw_frame() {
    const std::string width = std::to_string(width_);
    const std::string height = std::to_string(height_);
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
           "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"" + width +
           "\" height=\"" + height + "\" fill=\"white\"/>\n";
    for (const double value : x_.ticks()) {
      const double x = x_.place(value);
      line(x, y_.first, x, y_.last, "#dddddd");
      text(x, y_.first + 16, "middle", brief(value));
    }
    for (const double value : y_.ticks()) {
      const double y = y_.place(value);
      line(x_.first, y, x_.last, y, "#dddddd");
      text(x_.first - 6, y + 4, "end", brief(value));
    }
    text(kLeft, 24, "start", options_.title, " font-weight=\"bold\"");
    text((x_.first + x_.last) / 2, height_ - 14, "middle", options_.x_label);
    const double middle = (y_.first + y_.last) / 2;
    text(18, middle, "middle", options_.y_label,
         " transform=\"rotate(-90 18 " + brief(middle) + ")\"");
  }

  void draw_curve(size_t index) {
    const std::string colour = kColours[index % kColours.size()];
    // Beyond the number of colours, dashes tell curves apart.
    const std::string dash = index < kColours.size() ? "" : " stroke-dasharray=\"6 4\"";
    std::string points;
    for (const auto& p : curves_[index].points) {
      if (!drawable(p)) continue;
      const std::string x = brief(x_.place(p.first), 6);
      const std::string y = brief(y_.place(p.second), 6);
      points.append(x).append(",").append(y).append(" ");
      svg_.append("<circle cx=\"").append(x).append("\" cy=\"").append(y);
      svg_.append("\" r=\"3\" fill=\"").append(colour).append("\"/>\n");
    }
    const std::string stroke =
        "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"2\"" + dash;
    svg_ += "<polyline points=\"" + points + stroke + "/>\n";
    const double y = kTop + 8 + kLegendLine * static_cast<double>(index);
    line(x_.last + 12, y, x_.last + 34, y, colour, " stroke-width=\"2\"" + dash);
    text(x_.last + kLegendText, y + 4, "start", curves_[index].name);
  }

  void line(double x1, double y1, double x2, double y2, const std::string& colour,
            const std::string& more = {}) {
    svg_ += "<line x1=\"" + brief(x1, 6) + "\" y1=\"" + brief(y1, 6) + "\" x2=\"" + brief(x2, 6) +
            "\" y2=\"" + brief(y2, 6) + "\" stroke=\"" + colour + "\"" + more + "/>\n";
  }

  void text(double x, double y, const char* anchor, const std::string& words,
            const std::string& more = {}) {
    svg_ += "<text x=\"" + brief(x, 6) + "\" y=\"" + brief(y, 6) + "\" text-anchor=\"" + anchor +
            "\"" + more + ">" + escaped(words) + "</text>\n";
  }

  const std::vector<Curve>& curves_;
  const PlotOptions& options_;
  int width_ = 0;
  int height_ = 0;
  Axis x_;
  Axis y_;
  std::string svg_;
};

}  // namespace

Status plot_svg(const std::vector<Curve>& curves, const PlotOptions& options, std::string& out) {
  return Plot(curves, options).run(out);
}

}  // namespace reeb::tools
