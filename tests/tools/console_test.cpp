// The progress bar.
#include "tools/console.h"

#include <catch2/catch.hpp>

#include "tests/tools/run_command.h"

namespace reeb::tools {

TEST_CASE("a progress bar fits any terminal") {
  CHECK(bar_text("reading", 0.4, 65, 80) ==
        "reading [############                  ]  40 %, 1:05 left");
  CHECK(bar_text("reading", 0.4, -1, 80) == "reading [############                  ]  40 %");
  CHECK(bar_text("reading", 0.999, -1, 23) == "reading [###### ]  99 %");
  CHECK(bar_text("reading", 0.5, 5, 20) == "reading  50 %");
  CHECK(bar_text("reading", 1, 3725, 80) ==
        "reading [##############################] 100 %, 1:02:05 left");
  for (size_t width = 0; width < 100; ++width) {
    CHECK(bar_text("encoding", 1, 36000, width).size() <= width);
  }
}

TEST_CASE("a progress bar moves on while a point cache is read") {
  const TempFolder files;
  const std::string cache = files / "m.pc2";
  // 5 million floats: more than one report.
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "640", "-o", cache}).exit_code == 0);
  REQUIRE(std::filesystem::file_size(cache) > 4 * (size_t{1} << 22));
  const std::string err = run_reeb({"compare", cache, cache, "--progress", "always"}).err;
  CHECK_THAT(err, Catch::Contains("reading [") && Catch::Contains("100 %"));
  const size_t first = err.find(" %");
  CHECK(err.substr(first - 3, 3) != "100");
}

}  // namespace reeb::tools
