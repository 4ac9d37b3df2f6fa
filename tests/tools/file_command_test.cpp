// What happens to files before and behind the codec, tried on the command itself.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tools/command.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using nlohmann::json;

/// Three vertices one apart, 2,487,002.9 from the origin: binary32 has steps of 0.25 there. The
/// nearest values are off by 0.1, 0.1 and 0 in x, and by nothing in y and z.
const std::string kFar = "v 2487002.9 0 0\nv 2487003.9 1 0\nv 2487003.25 0 1\nf 1 2 3\n";

}  // namespace

TEST_CASE("errors are measured against what the file says") {
  const TempFolder folder;
  const std::string input = folder.write("far.obj", kFar);
  const std::string out = folder / "far.reeb";
  const CommandResult lossless = run_reeb({"encode", input, "-o", out, "--lossless", "--json"});
  REQUIRE(lossless.exit_code == kExitDone);
  CHECK_THAT(lossless.err, Contains("far.obj: binary32 does not hold") &&
                               Contains("by up to 0.1 (") && Contains("subtract an offset") &&
                               Contains("as binary32 holds it"));
  const json report = json::parse(lossless.out);
  CHECK(report["max_error"] == Approx(0.1).epsilon(1e-6));
  CHECK(report["rmse"] == Approx(std::sqrt(2 * 0.01 / 3)).epsilon(1e-6));
  CHECK(run_reeb({"compare", input, out, "--tolerance", "0"}).exit_code == kExitOverTolerance);
  CHECK_THAT(run_reeb({"compare", input, out}).out,
             Contains("maximum error  0.1 ") && !Contains("identical"));

  const CommandResult refused = run_reeb({"encode", input, "-f", "-o", out, "--max-error", "0.01"});
  CHECK(refused.exit_code != kExitDone);
  CHECK_THAT(refused.err,
             Contains("0.01 is out of reach") && Contains("rounds the positions by up to 0.1"));
  const CommandResult within =
      run_reeb({"encode", input, "-f", "-o", out, "--max-error", "0.2", "--json"});
  REQUIRE(within.exit_code == kExitDone);
  CHECK(json::parse(within.out)["max_error"] <= 0.2);

  const std::string plain = folder.write("near.obj", "v 0.1 0 0\nv 1 1 0\nv 2.125 0 1\nf 1 2 3\n");
  const CommandResult every_bit = run_reeb({"encode", plain, "-f", "-o", out, "--lossless"});
  CHECK_THAT(every_bit.err, Contains("every position is kept to the bit") && !Contains("binary32"));
}

TEST_CASE("frames keep the order in which they are named") {
  const TempFolder folder;
  std::vector<std::string> arguments{"encode", "-q", "--lossless", "-o", folder / "o.reeb"};
  for (const char* t : {"2", "0", "1"}) {
    arguments.push_back(
        folder.write(std::string("f_") + t + ".obj", std::string("v ") + t + " 0 0\n"));
  }
  REQUIRE(run_reeb(arguments).exit_code == kExitDone);
  REQUIRE(run_reeb({"decode", folder / "o.reeb", "-o", folder / "d_%d.obj"}).exit_code ==
          kExitDone);
  CHECK(read_text(folder / "d_1.obj") == "v 2 0 0\n");
  CHECK(read_text(folder / "d_2.obj") == "v 0 0 0\n");
  CHECK(read_text(folder / "d_3.obj") == "v 1 0 0\n");
}

TEST_CASE("a folder in brackets is no list") {
  const TempFolder folder;
  folder.write("[a,b]/f_1.obj", "v 1 0 0\n");
  const auto enter = [&] {
    if (::chdir(folder.path().c_str()) != 0) ::_exit(97);
  };
  const CommandResult result =
      run_reeb({"encode", "[a,b]", "-o", folder / "o.reeb", "--lossless"}, "/dev/null", enter);
  CHECK(result.err.find("no such file") == std::string::npos);
  CHECK(result.exit_code == kExitDone);
}

TEST_CASE("every command that decodes says how it can have more memory") {
  const TempFolder folder;
  const std::string cache = folder / "s.pc2", stream = folder / "s.reeb";
  REQUIRE(run_reeb({"sample", "sheet", "--length", "3", "-o", cache}).exit_code == kExitDone);
  REQUIRE(run_reeb({"encode", cache, "-o", stream}).exit_code == kExitDone);
  const std::vector<std::vector<std::string>> commands = {
      {"verify", stream},
      {"decode", stream, "-o", folder / "d.pc2"},
      {"compare", stream, stream},
      {"encode", stream, "-o", folder / "again.reeb"},
      {"picture", stream, stream, "-o", folder / "p.png"},
      {"segment", stream, "-o", folder / "regions.ply"}};
  for (std::vector<std::string> command : commands) {
    INFO(command[0]);
    CHECK(run_reeb(command).exit_code == kExitDone);
    command.insert(command.end(), {"--memory-limit", "100k"});
    if (command[0] != "verify" && command[0] != "compare") command.push_back("-f");
    const CommandResult result = run_reeb(command);
    CHECK(result.exit_code == kExitFailed);
    CHECK_THAT(result.err,
               Contains("s.reeb") && Contains("100,000 bytes") && Contains("--memory-limit"));
  }
}

TEST_CASE("a file beyond the size limit is an error that leaves nothing") {
  const TempFolder folder;
  REQUIRE(run_reeb({"sample", "sheet", "--length", "3", "-o", folder / "s.pc2"}).exit_code ==
          kExitDone);
  REQUIRE(run_reeb({"encode", folder / "s.pc2", "-o", folder / "s.reeb"}).exit_code == kExitDone);
  std::filesystem::create_directory(folder / "out");
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit small{20000, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  const CommandResult result =
      run_reeb({"decode", folder / "s.reeb", "-o", folder / "out/f_%d.obj"});
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  CHECK(result.exit_code == kExitFailed);
  CHECK_THAT(result.err, Contains("cannot be written"));
  CHECK(std::filesystem::is_empty(folder / "out"));
}

}  // namespace reeb::tools
