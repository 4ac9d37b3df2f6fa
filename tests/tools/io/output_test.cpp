#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/tools/temp_folder.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/output_set.h"
#include "tools/io/point_cache.h"
#include "tools/io/read_sequence.h"
#include "tools/io/write_sequence.h"

namespace reeb::tools {
namespace {

using Names = std::set<std::string>;

Sequence three_frames() {
  Sequence sequence;
  sequence.frame_rate = 25;
  sequence.start_time = 4;
  Shot& shot = sequence.shots.emplace_back();
  shot.connectivity = test_mesh("quad", square(), {{0, 1, 2, 3}, {0, 0, 1}}).connectivity;
  shot.frame_count = 3;
  for (int i = 0; i < 36; ++i) shot.positions.push_back(static_cast<float>(i) / 7);
  return sequence;
}

}  // namespace

TEST_CASE("an output set shows its files only when committed") {
  const TempFolder folder;
  OutputSet files(false);
  REQUIRE(files.prepare({folder / "b", folder / "new/deep/a"}).ok());
  REQUIRE(files.write(folder / "new/deep/a", "first ").ok());
  REQUIRE(files.write(folder / "new/deep/a", "second").ok());
  REQUIRE(files.write(folder / "b", "b").ok());
  CHECK_FALSE(std::filesystem::exists(folder / "b"));
  CHECK_FALSE(std::filesystem::exists(folder / "new/deep/a"));
  REQUIRE(files.commit().ok());
  CHECK(folder.names() == Names{"b", "new", "new/deep", "new/deep/a"});
  CHECK(read_text(folder / "new/deep/a") == "first second");
}

TEST_CASE("an abandoned output set leaves nothing, not even its folders") {
  const TempFolder folder;
  folder.write("kept", "old");
  {
    OutputSet files(true);
    REQUIRE(files.prepare({folder / "kept", folder / "new/a"}).ok());
    REQUIRE(files.write(folder / "kept", "new").ok());
    REQUIRE(files.write(folder / "new/a", "x").ok());
    CHECK(folder.names().size() == 4);
  }
  CHECK(folder.names() == Names{"kept"});
  CHECK(read_text(folder / "kept") == "old");
}

TEST_CASE("an output set refuses to overwrite unless told to") {
  const TempFolder folder;
  folder.write("a", "old");
  OutputSet careful(false);
  CHECK_THAT(careful.prepare({folder / "a"}).message(), Catch::Contains("-f"));
  OutputSet bold(true);
  REQUIRE(bold.prepare({folder / "a"}).ok());
  REQUIRE(bold.write(folder / "a", "new").ok());
  REQUIRE(bold.commit().ok());
  CHECK(read_text(folder / "a") == "new");
  CHECK_FALSE(bold.prepare({folder.path()}).ok());
  CHECK_FALSE(bold.write(folder / "unannounced", "x").ok());
}

TEST_CASE("a target that appears in the meantime is not overwritten") {
  const TempFolder folder;
  OutputSet files(false);
  REQUIRE(files.prepare({folder / "a"}).ok());
  REQUIRE(files.write(folder / "a", "ours").ok());
  folder.write("a", "theirs");
  CHECK_FALSE(files.commit().ok());
  CHECK(read_text(folder / "a") == "theirs");
}

TEST_CASE("special files and links stay what they are") {
  const TempFolder folder;
  std::filesystem::create_symlink("real", folder / "link");
  folder.write("real", "old");
  OutputSet files(true);
  REQUIRE(files.prepare({"/dev/null", folder / "link"}).ok());
  REQUIRE(files.write("/dev/null", "gone").ok());
  REQUIRE(files.write(folder / "link", "new").ok());
  REQUIRE(files.commit().ok());
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(read_text(folder / "real") == "new");
}

TEST_CASE("a set whose last file cannot get its name changes nothing") {
  for (const bool there_before : {false, true}) {
    const TempFolder folder;
    if (there_before) folder.write("a", "old");
    const Names before = folder.names();
    {
      OutputSet files(true);
      REQUIRE(files.prepare({folder / "a", folder / "b", folder / "c"}).ok());
      for (const char* name : {"a", "b", "c"}) REQUIRE(files.write(folder / name, "new").ok());
      folder.write("c/kept", "in what has become a folder");
      CHECK_THAT(files.commit().message(), Catch::Contains(folder / "c"));
    }
    Names after = before;
    after.insert({"c", "c/kept"});
    CHECK(folder.names() == after);
    if (there_before) CHECK(read_text(folder / "a") == "old");
  }
}

TEST_CASE("a temporary file that is taken away or replaced halts the whole set") {
  for (const bool by_link : {false, true}) {
    const TempFolder folder;
    folder.write("a", "old a");
    folder.write("victim", "precious");
    OutputSet files(true);
    REQUIRE(files.prepare({folder / "a", folder / "b"}).ok());
    REQUIRE(files.write(folder / "a", "new").ok());
    Names others = folder.names();
    REQUIRE(files.write(folder / "b", "new").ok());
    for (const std::string& name : folder.names()) {
      if (others.count(name) == 1) continue;
      std::filesystem::remove(folder / name);
      if (by_link) std::filesystem::create_symlink("victim", folder / name);
    }
    CHECK_FALSE(files.write(folder / "b", "more").ok());
    CHECK_FALSE(files.commit().ok());
    CHECK(read_text(folder / "a") == "old a");
    CHECK(read_text(folder / "victim") == "precious");
    CHECK_FALSE(std::filesystem::exists(folder / "b"));
  }
}

TEST_CASE(
    "temporary names differ each time, and fit where the target's name is as long as may be") {
  const TempFolder folder;
  const std::string longest(255, 'x');
  std::set<std::string> seen;
  for (int i = 0; i < 3; ++i) {
    OutputSet files(true);
    REQUIRE(files.prepare({folder / longest}).ok());
    REQUIRE(files.write(folder / longest, "text").ok());
    for (const std::string& name : folder.names()) {
      if (name != longest) CHECK(seen.insert(name).second);
    }
    REQUIRE(files.commit().ok());
  }
  CHECK(seen.size() == 3);
  CHECK(folder.names() == Names{longest});
}

TEST_CASE("of two writers one wins, whole") {
  const TempFolder folder;
  for (const bool overwrite : {false, true}) {
    const std::string target = folder / (overwrite ? "with" : "without");
    OutputSet first(overwrite);
    OutputSet second(overwrite);
    for (OutputSet* set : {&first, &second}) REQUIRE(set->prepare({target}).ok());
    REQUIRE(first.write(target, "first ").ok());
    REQUIRE(second.write(target, "second ").ok());
    REQUIRE(first.write(target, "writer").ok());
    REQUIRE(second.write(target, "writer").ok());
    REQUIRE(first.commit().ok());
    CHECK(second.commit().ok() == overwrite);
    CHECK(read_text(target) == (overwrite ? "second writer" : "first writer"));
  }
  CHECK(folder.names() == Names{"with", "without"});
}

TEST_CASE("new files have the permissions that the user's mask leaves") {
  const TempFolder folder;
  const mode_t mask = ::umask(027);
  OutputSet files(false);
  REQUIRE(files.prepare({folder / "a"}).ok());
  REQUIRE(files.write(folder / "a", "x").ok());
  REQUIRE(files.commit().ok());
  ::umask(mask);
  CHECK(std::filesystem::status(folder / "a").permissions() == std::filesystem::perms{0640});
}

TEST_CASE("overwriting keeps the permissions of a file") {
  const TempFolder folder;
  for (const unsigned mode : {0600u, 0660u, 0755u, 0644u}) {
    folder.write("a", "before");
    std::filesystem::permissions(folder / "a", std::filesystem::perms{mode});
    OutputSet files(true);
    REQUIRE(files.prepare({folder / "a"}).ok());
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      CHECK(entry.status().permissions() ==
            std::filesystem::perms{mode});  // the temporary one, too
    REQUIRE(files.write(folder / "a", "x").ok());
    REQUIRE(files.commit().ok());
    CHECK(std::filesystem::status(folder / "a").permissions() == std::filesystem::perms{mode});
    CHECK(read_text(folder / "a") == "x");
  }
}

TEST_CASE("a write-protected file is not overwritten") {
  const TempFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  folder.write("a", "before");
  std::filesystem::permissions(folder / "a", std::filesystem::perms{0444});
  const uid_t user = ::geteuid();
  if (user == 0) REQUIRE(::seteuid(65534) == 0);  // root may write to anything
  OutputSet files(true);
  const Status status = files.prepare({folder / "a"});
  if (user == 0) REQUIRE(::seteuid(user) == 0);
  CHECK_THAT(status.message(), Catch::Contains("a: cannot be overwritten (Permission denied)"));
  CHECK(folder.names() == std::set<std::string>{"a"});
}

TEST_CASE("output names") {
  const TempFolder folder;
  OutputName name;
  using Kind = OutputName::Kind;
  REQUIRE(parse_output_name("o/f_%03d.ply", 5, "", name).ok());
  CHECK(name.kind == Kind::kFrames);
  REQUIRE(parse_output_name("o/x.pc2", 5, "", name).ok());
  CHECK(name.kind == Kind::kCache);
  REQUIRE(parse_output_name("x.obj", 1, "", name).ok());
  CHECK(name.kind == Kind::kSingleMesh);
  REQUIRE(parse_output_name(folder.path().string(), 5, "", name).ok());
  CHECK(name.pattern == folder / "frame_%04d.obj");
  REQUIRE(parse_output_name("new_folder", 5, "", name).ok());
  CHECK(name.pattern == "new_folder/frame_%04d.obj");
  CHECK_THAT(parse_output_name("x.obj", 5, "", name).message(), Catch::Contains("x_%04d.obj"));
  CHECK_FALSE(parse_output_name("x.txt", 1, "", name).ok());
  CHECK_FALSE(parse_output_name("x_%04d.txt", 1, "", name).ok());
}

TEST_CASE("sequences survive every output to the bit") {
  const TempFolder folder;
  const Sequence sequence = three_frames();
  for (const std::string name :
       {"a/f_%04d.obj", "b/f%d.ply", "c/f_%02d.off", "d/x.pc2", "e/x.mdd"}) {
    INFO(name);
    REQUIRE(write_sequence(source_of(sequence), folder / name, {}).ok());
    Sequence back;
    ReadReport report;
    REQUIRE(read_sequence({folder / name.substr(0, 1)}, {}, back, report).ok());
    REQUIRE(back.shots.size() == 1);
    CHECK(back.shots[0].connectivity == sequence.shots[0].connectivity);
    CHECK(back.shots[0].positions == sequence.shots[0].positions);
    if (name == "d/x.pc2" || name == "e/x.mdd") CHECK(back.start_time == 4);
    if (name == "e/x.mdd") CHECK(back.frame_rate == 25);
  }
  CHECK(folder.names().count("a/f_0003.obj") == 1);
  CHECK(folder.names().count("d/x.obj") == 1);
}

TEST_CASE("frame files are all there or none is") {
  const TempFolder folder;
  const Sequence sequence = three_frames();
  FrameSource source = source_of(sequence);
  const auto good = source.frame;
  source.frame = [&](uint32_t i, SourceFrame& out) {
    return i == 2 ? Status::corrupt("frame 3 is broken") : good(i, out);
  };
  for (const char* name : {"out/f_%04d.obj", "out.pc2"}) {
    const Status status = write_sequence(source, folder / name, {.threads = 1});
    CHECK(status.message() == "frame 3 is broken");
    CHECK(folder.names().empty());
  }

  folder.write("f_0002.obj", "old");
  CHECK_FALSE(write_sequence(source_of(sequence), folder / "f_%04d.obj", {}).ok());
  CHECK(folder.names() == Names{"f_0002.obj"});
  CHECK(read_text(folder / "f_0002.obj") == "old");
  REQUIRE(write_sequence(source_of(sequence), folder / "f_%04d.obj", {.overwrite = true}).ok());
  CHECK(folder.names().size() == 3);
}

TEST_CASE("a cache refuses a change of connectivity, frame files take it") {
  const TempFolder folder;
  Sequence sequence = three_frames();
  sequence.shots.push_back({plain_mesh().connectivity, 1, plain_mesh().positions});
  const Status status = write_sequence(source_of(sequence), folder / "x.pc2", {});
  CHECK_THAT(status.message(), Catch::Contains("frame 4"));
  CHECK(folder.names().empty());
  CHECK(write_sequence(source_of(sequence), folder / "f_%d.obj", {}).ok());
}

TEST_CASE("a full disk is reported and leaves nothing") {
  if (!std::filesystem::exists("/dev/full")) return;
  OutputSet files(true);
  REQUIRE(files.prepare({"/dev/full"}).ok());
  const Status status = files.write("/dev/full", "x");
  CHECK_FALSE(status.ok());
  CHECK_THAT(status.message(), Catch::Contains("/dev/full"));
}

}  // namespace reeb::tools
