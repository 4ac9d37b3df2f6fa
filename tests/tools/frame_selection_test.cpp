// --frames: one meaning in all commands.
#include "tools/frame_selection.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tools/command.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using nlohmann::json;
using Numbers = std::vector<uint32_t>;

Numbers of_ten(const std::string& text) {
  FrameSelection selection;
  CHECK(FrameSelection::parse(text, selection).empty());
  Numbers out;
  CHECK(selection.numbers(10, out).ok());
  return out;
}

/// Frame t of one vertex, at (t, 0, 0); from frame 4 on with another face.
Sequence line() {
  Sequence out;
  out.start_time = 100;
  for (uint32_t t = 1; t <= 6; ++t) {
    if (t == 1 || t == 4) {
      out.shots.emplace_back().connectivity.vertex_count = 1;
      out.shots.back().connectivity.face_sizes = {1};
      out.shots.back().connectivity.corners = {0};
    }
    const float x = static_cast<float>(t);
    out.shots.back().positions.insert(out.shots.back().positions.end(), {x, 0, 0});
    ++out.shots.back().frame_count;
  }
  return out;
}

}  // namespace

TEST_CASE("frames as they are typed") {
  CHECK(of_ten("7") == Numbers{7});
  CHECK(of_ten("2:4") == Numbers{2, 3, 4});
  CHECK(of_ten("9:") == Numbers{9, 10});
  CHECK(of_ten(":2") == Numbers{1, 2});
  CHECK(of_ten("3:1") == Numbers{3, 2, 1});
  CHECK(of_ten("1,5:6,2") == Numbers{1, 5, 6, 2});
  CHECK(of_ten(":").size() == 10);
  FrameSelection selection;
  CHECK(selection.empty());
  for (const char* bad : {"", "0", "-1", "1.5", "x", "1:x", "1,,2", "1,", "1-2", "99999999999"}) {
    INFO(bad);
    CHECK_THAT(FrameSelection::parse(bad, selection), Contains("does not name frames"));
  }
  Numbers out;
  CHECK(FrameSelection::parse("2:11", selection).empty());
  CHECK_THAT(selection.numbers(10, out).message(),
             Contains("frame 11 does not exist") && Contains("1 to 10"));
  CHECK_THAT(selection.numbers(0, out).message(), !Contains("1 to 0"));
}

TEST_CASE("frames are picked from their shots") {
  const Sequence all = line();
  const Sequence part = pick_frames(all, {3, 5, 6});
  REQUIRE(part.shots.size() == 2);
  CHECK(part.shots[0].positions == std::vector<float>{3, 0, 0});
  CHECK(part.shots[1].positions == std::vector<float>{5, 0, 0, 6, 0, 0});
  CHECK(part.start_time == 102);
  const Sequence back = pick_frames(all, {6, 5});
  REQUIRE(back.shots.size() == 1);
  CHECK(back.shots[0].positions == std::vector<float>{6, 0, 0, 5, 0, 0});
  CHECK(back.start_time == 100);
}

TEST_CASE("--frames means the same in every command") {
  const TempFolder files;
  const std::string cache = files / "m.pc2", stream = files / "m.reeb";
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "6", "-o", cache}).exit_code == 0);
  REQUIRE(run_reeb({"encode", cache, "-o", stream}).exit_code == 0);
  for (const auto& [frames, count] :
       {std::pair<std::string, int>{"2:4", 3}, {"5", 1}, {"1,3:4", 3}, {"6:1", 6}}) {
    INFO(frames);
    REQUIRE(
        run_reeb({"encode", cache, "-f", "-o", files / "p.reeb", "--frames", frames}).exit_code ==
        0);
    REQUIRE(
        run_reeb({"decode", stream, "-f", "-o", files / "d.pc2", "--frames", frames}).exit_code ==
        0);
    const CommandResult same =
        run_reeb({"compare", files / "p.reeb", files / "d.pc2", "--tolerance", "0.2", "--json"});
    CHECK(same.exit_code == kExitDone);
    CHECK(json::parse(same.out)["frames"] == count);
    const CommandResult compared =
        run_reeb({"compare", cache, stream, "--json", "--frames", frames});
    CHECK(json::parse(compared.out)["frames"] == count);
    CHECK(run_reeb(
              {"picture", cache, "-f", "-o", files / "p.png", "--tile", "20", "--frames", frames})
              .err ==
          files / ("p.png: " + std::to_string(count) + (count == 1 ? " frame\n" : " frames\n")));
  }
  const std::vector<std::vector<std::string>> commands{
      {"encode", cache, "-f", "-o", files / "p.reeb"},
      {"decode", stream, "-f", "-o", files / "d.pc2"},
      {"compare", cache, stream},
      {"picture", cache, "-f", "-o", files / "p.png"}};
  for (std::vector<std::string> command : commands) {
    INFO(command[0]);
    command.insert(command.end(), {"--frames", "7"});
    CHECK_THAT(run_reeb(command).err, Contains("frame 7 does not exist; there are frames 1 to 6"));
    command.back() = "0";
    CHECK(run_reeb(command).exit_code == kExitUsage);
  }
}

TEST_CASE("a mesh is named before its point cache") {
  CHECK(split_sequences({"a.obj", "b.pc2"}, 2).size() == 2);
  using Sides = std::vector<std::vector<std::string>>;
  CHECK(split_sequences({"a.obj", "b.pc2"}, 1) == Sides{{"a.obj", "b.pc2"}});
  CHECK(split_sequences({"a.obj", "b.pc2", "c.reeb"}, 2) == Sides{{"a.obj", "b.pc2"}, {"c.reeb"}});
  CHECK(split_sequences({"c.reeb", "a.obj", "b.mdd"}, 2) == Sides{{"c.reeb"}, {"a.obj", "b.mdd"}});
  CHECK(split_sequences({"a.obj", "b.pc2", "a.ply", "d.MDD"}, 2) ==
        Sides{{"a.obj", "b.pc2"}, {"a.ply", "d.MDD"}});

  const TempFolder files;
  const std::string cache = files / "moved/m.pc2", stream = files / "m.reeb";
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "3", "-o", cache}).exit_code == 0);
  std::filesystem::rename(files / "moved/m.obj", files / "mesh.obj");
  REQUIRE(run_reeb({"encode", files / "mesh.obj", cache, "-o", stream}).exit_code == 0);
  const CommandResult refused = run_reeb({"compare", cache, stream});
  CHECK(refused.exit_code == kExitFailed);
  CHECK_THAT(refused.err, Contains("name the mesh before the cache"));
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"compare", files / "mesh.obj", cache, stream},
        {"compare", stream, files / "mesh.obj", cache},
        {"picture", files / "mesh.obj", cache, stream, "-f", "-o", files / "p.png"},
        {"picture", files / "mesh.obj", cache, "-f", "-o", files / "p.png"}}) {
    const CommandResult result = run_reeb(command);
    INFO(result.err);
    CHECK(result.exit_code == kExitDone);
  }
  CHECK(run_reeb({"compare", stream}).exit_code == kExitUsage);
  CHECK(run_reeb({"compare", files / "mesh.obj", cache, cache, stream, stream}).exit_code ==
        kExitUsage);
}

}  // namespace reeb::tools
