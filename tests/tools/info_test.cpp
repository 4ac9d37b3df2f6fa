// What a file says of how it was made, and `reeb info` of it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tools/command.h"
#include "tools/encoding_report.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using nlohmann::json;

json info_of(const std::string& stream) {
  const CommandResult result = run_reeb({"info", stream, "--json"});
  REQUIRE(result.exit_code == kExitDone);
  return json::parse(result.out);
}

/// A square that moves away along x and comes back, as files.
class Square : public TempFolder {
 public:
  Square() {
    for (int t = 0; t < 4; ++t) {
      const std::string x = std::to_string(t == 3 ? 0 : 2 * t);
      write("s/f_" + std::to_string(t) + ".obj", "v " + x + " -1 0.5\nv " + x + " 1 0.5\nv " + x +
                                                     " 1 2.5\nv " + x + " -1 2.5\nf 1 2 3 4\n");
    }
  }

  json encode(const std::vector<std::string>& options) const {
    std::vector<std::string> line{"encode", *this / "s", "-o", stream, "-f", "--json"};
    line.insert(line.end(), options.begin(), options.end());
    const CommandResult result = run_reeb(line);
    INFO(result.err);
    REQUIRE(result.exit_code == kExitDone);
    return json::parse(result.out);
  }
  const std::string stream = *this / "s.reeb";
};

}  // namespace

TEST_CASE("reports are written and read", "[info]") {
  const EncodingReport kg{"kg", 0.05, 0.0498712, 0.00123, 0.0101};
  CHECK(report_text(kg) == "kg 0.05: kg 0.04987, rmse 0.00123, max-error 0.0101");
  const EncodingReport size{"size", 123456789, 1, 2e-7, 3};
  CHECK(report_text(size) == "size 123456789: kg 1, rmse 2e-07, max-error 3");
  const EncodingReport exact{"lossless", 0, 0, 0, 0};
  CHECK(report_text(exact) == "lossless: kg 0, rmse 0, max-error 0");

  EncodingReport read;
  REQUIRE(parse_report(report_text(size), read));
  CHECK(read.target == "size");
  CHECK(read.wanted == 123456789);
  CHECK(read.rmse == 2e-7);
  REQUIRE(parse_report(report_text(exact), read));
  CHECK(read.target == "lossless");
  for (const char* bad : {"", "kg", "kg 1", "kg 1: kg 1, rmse 1", "kg x: kg 1, rmse 1, max-error 1",
                          "kg 1: kg 1, rmse 1, max-error 1 ", "kg 1: kg nan, rmse 1, max-error 1",
                          "kg 1: rmse 1, kg 1, max-error 1", "kg 1: kg -1, rmse 1, max-error 1",
                          "best 1: kg 1, rmse 1, max-error 1"}) {
    INFO(bad);
    CHECK_FALSE(parse_report(bad, read));
  }
}

TEST_CASE("info tells how a file was made", "[info]") {
  const TempFolder folder;
  const std::string cache = folder / "m.pc2", stream = folder / "m.reeb";
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "6", "-o", cache}).exit_code == 0);
  const CommandResult encoded =
      run_reeb({"encode", cache, "-o", stream, "--kg", "0.25", "--profile", "fast", "--json"});
  REQUIRE(encoded.exit_code == kExitDone);
  const json made = json::parse(encoded.out);
  CHECK(made["bytes"] == std::filesystem::file_size(stream));

  const json told = info_of(stream);
  CHECK(told["profiles"] == json{"fast"});
  CHECK(told["groups"][0]["profile"] == "fast");
  CHECK(told["target"] == json{{"kind", "kg"}, {"value", 0.25}});
  const json compared = json::parse(run_reeb({"compare", cache, stream, "--json"}).out);
  CHECK(told["error"]["kg"].get<double>() == Approx(compared["kg"].get<double>()).epsilon(1e-3));
  CHECK(told["error"]["max_error"].get<double>() ==
        Approx(made["max_error"].get<double>()).epsilon(1e-3));
  double sections = 0;
  for (const auto& [name, bytes] : made["sections"].items()) {
    sections += bytes.get<double>();
    CHECK(told["sections"][name] == bytes);
  }
  CHECK(sections == made["bytes"]);
  const std::string text = run_reeb({"info", stream}).out;
  CHECK_THAT(text, Contains("fast profile, target: KG 0.25 %\nerror when encoded: KG 0.2") &&
                       Contains("within (") && !Contains("encoding ="));

  // Encoded once more, it is told of the last time.
  REQUIRE(run_reeb({"encode", stream, "-o", folder / "n.reeb", "--lossless"}).exit_code == 0);
  const json again = info_of(folder / "n.reeb");
  CHECK(again["target"] == json{{"kind", "lossless"}, {"value", 0.0}});
  CHECK(again["error"] == json{{"kg", 0.0}, {"rmse", 0.0}, {"max_error", 0.0}});
  CHECK(again["profiles"] == json{"lossless"});
}

TEST_CASE("info tells the box of a file and of its groups", "[info]") {
  const Square square;
  square.encode({"--lossless", "--group-length", "2"});
  const json told = info_of(square.stream);
  CHECK(told["box"] == json{{"low", {0, -1, 0.5}}, {"high", {4, 1, 2.5}}});
  REQUIRE(told["groups"].size() == 2);
  CHECK(told["groups"][0]["box"] == json{{"low", {0, -1, 0.5}}, {"high", {2, 1, 2.5}}});
  CHECK(told["groups"][1]["box"] == json{{"low", {0, -1, 0.5}}, {"high", {4, 1, 2.5}}});
  CHECK_THAT(run_reeb({"info", square.stream}).out, Contains("within (0, -1, 0.5) to (4, 1, 2.5)"));
}

TEST_CASE("without a report nothing is told and less is kept", "[info]") {
  const Square square;
  const json with = square.encode({"--max-error", "0.01"});
  CHECK(info_of(square.stream)["target"] == json{{"kind", "max-error"}, {"value", 0.01}});
  const json without = square.encode({"--max-error", "0.01", "--no-report"});
  const json told = info_of(square.stream);
  for (const char* field : {"target", "error", "box"}) CHECK(told[field].is_null());
  CHECK(told["metadata"].empty());
  CHECK_FALSE(told["groups"][0].contains("box"));
  CHECK(without["bytes"].get<int>() + 60 < with["bytes"].get<int>());
}

TEST_CASE("report and boxes count for a target that is a size", "[info]") {
  const TempFolder folder;
  const std::string cache = folder / "m.pc2", stream = folder / "m.reeb";
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "40", "-o", cache}).exit_code == 0);
  REQUIRE(run_reeb({"encode", cache, "-o", stream, "--size", "30k", "--group-length", "4", "-q"})
              .exit_code == kExitDone);
  const auto bytes = std::filesystem::file_size(stream);
  CHECK(bytes <= 30'000);
  CHECK(bytes > 29'700);
  CHECK(info_of(stream)["groups"].size() == 10);
  CHECK_THAT(run_reeb({"info", stream}).out, Contains("target: 30,000 bytes"));
}

TEST_CASE("info takes several files", "[info]") {
  const Square square;
  square.encode({"--lossless"});
  const std::string other = square / "other.reeb";
  REQUIRE(run_reeb({"encode", square / "s", "-o", other, "--bpvf", "200", "--profile", "thesis"})
              .exit_code == kExitDone);
  const CommandResult both = run_reeb({"info", square.stream, other});
  CHECK(both.exit_code == kExitDone);
  CHECK_THAT(both.out, Contains("s.reeb: ") && Contains("other.reeb: ") &&
                           Contains("lossless profile") && Contains("thesis profile"));
  const json told = json::parse(run_reeb({"info", square.stream, other, "--json"}).out);
  REQUIRE(told.size() == 2);
  CHECK(told[0]["file"] == square.stream);
  CHECK(told[1]["target"] == json{{"kind", "bpvf"}, {"value", 200.0}});

  // One that cannot be read costs that one.
  const CommandResult partly = run_reeb({"info", square.stream, square / "none.reeb", other});
  CHECK(partly.exit_code == kExitFailed);
  CHECK_THAT(partly.err, Contains("none.reeb"));
  CHECK_THAT(partly.out, Contains("s.reeb: ") && Contains("other.reeb: "));
}

}  // namespace reeb::tools
