#include "tools/picture/plot.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace reeb::tools {
namespace {

size_t count(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("tables with quotes, comments and carriage returns") {
  CsvTable table;
  REQUIRE(parse_csv("# rates\na,b\r\n1,\"x, \"\"y\"\"\"\r\n\n2,\n", table).ok());
  CHECK(table.columns == std::vector<std::string>{"a", "b"});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0][1] == "x, \"y\"");
  CHECK(table.rows[1][1].empty());
  CHECK(table.find("b") == 1);
  CHECK(table.find("c") == -1);
  CHECK_THAT(parse_csv("a,b\n1,2\n3\n", table).message(), Catch::Contains("line 3"));
}

TEST_CASE("rows become curves by their series, sorted") {
  CsvTable table;
  REQUIRE(parse_csv("s,t,x,y\ncow,1,2,5\ncow,2,1,1\ncow,1,1,6\ncow,1,none,6\n", table).ok());
  std::vector<Curve> curves;
  REQUIRE(curves_of(table, "x", "y", {"s", "t"}, curves).ok());
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].name == "cow 1");
  CHECK(curves[0].points == std::vector<std::pair<double, double>>{{1, 6}, {2, 5}});
  CHECK(curves[1].name == "cow 2");
  CHECK_THAT(curves_of(table, "z", "y", {}, curves).message(), Catch::Contains("'z'"));
  CHECK_FALSE(curves_of(table, "s", "y", {}, curves).ok());
}

TEST_CASE("a plot places points by their logarithms") {
  // x from 1 to 100, y from 1 to 10: the middle point lies half-way between the others in both.
  const std::vector<Curve> curves{
      {"a <b>", {{1, 1}, {10, std::sqrt(10.0)}, {100, 10}}},
      {"none", {{0, 1}, {1, -1}, {std::numeric_limits<double>::infinity(), 1}}}};
  std::string svg;
  REQUIRE(plot_svg(curves, {"title", "rate", "error"}, svg).ok());
  CHECK(count(svg, "<circle") == 3);
  CHECK(count(svg, "<polyline") == 2);
  CHECK(count(svg, "a &lt;b>") == 1);
  std::vector<double> x;
  std::vector<double> y;
  for (size_t at = svg.find("<circle"); at != svg.npos; at = svg.find("<circle", at + 1)) {
    x.push_back(std::stod(svg.substr(svg.find("cx=\"", at) + 4)));
    y.push_back(std::stod(svg.substr(svg.find("cy=\"", at) + 4)));
  }
  CHECK(x[1] == Approx((x[0] + x[2]) / 2));
  CHECK(y[1] == Approx((y[0] + y[2]) / 2));
  CHECK(x[0] < x[2]);
  CHECK(y[0] > y[2]);
  CHECK_FALSE(plot_svg({curves[1]}, {}, svg).ok());
}

TEST_CASE("the legend is inside the page, however long and many its names are") {
  std::vector<Curve> curves(40, {std::string(60, 'w'), {{1, 1}, {2, 2}}});
  std::string svg;
  REQUIRE(plot_svg(curves, {}, svg).ok());
  const auto number = [&](const std::string& name, size_t from) {
    return std::stod(svg.substr(svg.find(name + "=\"", from) + name.size() + 2));
  };
  const double width = number("width", 0);
  const double height = number("height", 0);
  size_t names = 0;
  for (size_t at = svg.find("<text"); at != svg.npos; at = svg.find("<text", at + 1)) {
    if (svg.compare(svg.find('>', at) + 1, 2, "ww") != 0) continue;
    ++names;
    CHECK(number("x", at) + 60 * 7 < width);  // 12 pixels high, letters are some 7 wide
    CHECK(number("y", at) < height);
  }
  CHECK(names == 40);
}

}  // namespace reeb::tools
