#include "tools/io/frame_list.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/tools/temp_folder.h"

namespace reeb::tools {
namespace {

std::vector<std::string> found(const std::vector<std::string>& inputs, bool allow_gaps = false) {
  InputFiles files;
  const Status status = find_input(inputs, allow_gaps, files);
  INFO(status.message());
  REQUIRE(status.ok());
  std::vector<std::string> names;
  for (const auto& f : files.meshes) names.push_back(f.filename().string());
  if (!files.cache.empty()) names.push_back(files.cache.filename().string());
  if (!files.stream.empty()) names.push_back(files.stream.filename().string());
  return names;
}

std::string failure(const std::vector<std::string>& inputs) {
  InputFiles files;
  const Status status = find_input(inputs, false, files);
  REQUIRE_FALSE(status.ok());
  return status.message();
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a folder, a pattern and a list give the same frames in natural order") {
  const TempFolder folder;
  for (int i = 8; i <= 11; ++i) folder.write(std::to_string(i).insert(0, 1, 'f') + ".obj", "");
  folder.write("notes.txt", "");
  folder.write(".f12.obj", "");
  const Names expected{"f8.obj", "f9.obj", "f10.obj", "f11.obj"};
  CHECK(found({folder.path().string()}) == expected);
  CHECK(found({folder / "f*.obj"}) == expected);
  CHECK(found({folder / "f?.obj"}) == Names{"f8.obj", "f9.obj"});
  CHECK(found({folder / "f%d.obj"}) == expected);
  // As a shell expands it; the note says so.
  const std::vector<std::string> expanded{folder / "f10.obj", folder / "f11.obj", folder / "f8.obj",
                                          folder / "f9.obj"};
  CHECK(found(expanded) == expected);
  InputFiles files;
  REQUIRE(find_input(expanded, false, files).ok());
  REQUIRE(files.notes.size() == 1);
  CHECK_THAT(files.notes[0], Catch::Contains("ordered by number"));
}

TEST_CASE("files named one by one keep their order") {
  const TempFolder folder;
  for (const char* name : {"f_0.obj", "f_1.obj", "f_2.obj", "f_5.obj", "f_1 copy.obj"}) {
    folder.write(name, "");
  }
  CHECK(found({folder / "f_2.obj", folder / "f_1.obj", folder / "f_0.obj"}) ==
        Names{"f_2.obj", "f_1.obj", "f_0.obj"});
  CHECK(found({folder / "f_0.obj", folder / "f_5.obj", folder / "f_1.obj"}) ==
        Names{"f_0.obj", "f_5.obj", "f_1.obj"});
  CHECK(found({folder / "f_0.obj", folder / "f_0.obj"}) == Names{"f_0.obj", "f_0.obj"});
  CHECK_THAT(failure({folder / "f_0.obj", folder / "f_1.obj", folder / "f_5.obj"}),
             Catch::Contains("f_2.obj: frame 2 is missing"));
  // A stray among them is told, but may be meant.
  InputFiles files;
  const std::vector<std::string> with_copy{folder / "f_0.obj", folder / "f_1 copy.obj",
                                           folder / "f_1.obj"};
  REQUIRE(find_input(with_copy, false, files).ok());
  CHECK(files.meshes[1].filename() == "f_1 copy.obj");
  REQUIRE(files.notes.size() == 1);
  CHECK_THAT(files.notes[0], Catch::Contains("not named like") && Catch::Contains("order given"));
}

TEST_CASE("a stray beside a sequence is an error") {
  const TempFolder folder;
  for (const char* name : {"f_1.obj", "f_2.obj", "f_2 copy.obj", "f_5.obj"}) folder.write(name, "");
  for (const std::string& input : {folder.path().string(), folder / "*.obj"}) {
    CHECK_THAT(failure({input}),
               Catch::Contains("f_2 copy.obj: not named like") && Catch::Contains("one by one"));
  }
}

TEST_CASE("negative numbers count in folders and in patterns") {
  const TempFolder folder;
  for (const char* name : {"f_-2.obj", "f_-1.obj", "f_0.obj", "f_1.obj"}) folder.write(name, "");
  const Names expected{"f_-2.obj", "f_-1.obj", "f_0.obj", "f_1.obj"};
  CHECK(found({folder.path().string()}) == expected);
  CHECK(found({folder / "f_%d.obj"}) == expected);
  CHECK(found({folder / "*.obj"}) == expected);
}

TEST_CASE("names with the characters of patterns are found as they stand") {
  const TempFolder folder;
  for (const char* odd : {"a[1]", "b*", "c%d", "d?", "e%04d[x]"}) {
    const std::string name = odd;
    INFO(name);
    folder.write(name + "/f_1.obj", "");
    folder.write(name + "/f_2.obj", "");
    folder.write(name + ".obj", "");
    const Names both{"f_1.obj", "f_2.obj"};
    CHECK(found({folder / name}) == both);
    CHECK(found({folder / (name + "/*.obj")}) == both);
    CHECK(found({folder / (name + "/f_%d.obj")}) == both);
    CHECK(found({folder / (name + ".obj")}) == Names{name + ".obj"});
  }
  // What is no name is a pattern still.
  CHECK(found({folder / "a[[]1]/*.obj"}) == Names{"f_1.obj", "f_2.obj"});
}

TEST_CASE("extensions count in any case") {
  const TempFolder folder;
  folder.write("m/walk.OBJ", "");
  folder.write("m/walk.PC2", "");
  folder.write("s.REEB", "");
  CHECK(found({folder / "m/walk.PC2"}) == Names{"walk.OBJ", "walk.PC2"});
  InputFiles files;
  REQUIRE(find_input({folder / "s.REEB"}, false, files).ok());
  CHECK(files.stream.filename() == "s.REEB");
}

TEST_CASE("a width in a printf pattern counts") {
  const TempFolder folder;
  for (const char* name : {"f_0001.ply", "f_0002.ply", "f_03.ply", "f_x.ply"})
    folder.write(name, "");
  CHECK(found({folder / "f_%04d.ply"}) == Names{"f_0001.ply", "f_0002.ply"});
}

TEST_CASE("a gap is an error that names the missing file and the way out") {
  const TempFolder folder;
  for (const char* name : {"w_08.obj", "w_09.obj", "w_11.obj"}) folder.write(name, "");
  const std::string message = failure({folder.path().string()});
  CHECK_THAT(message, Catch::Contains("w_10.obj") && Catch::Contains("frame 10 is missing") &&
                          Catch::Contains("--allow-gaps"));
  CHECK(found({folder.path().string()}, true) == Names{"w_08.obj", "w_09.obj", "w_11.obj"});
}

TEST_CASE("the number that varies is the frame number, wherever it stands") {
  const TempFolder folder;
  for (const char* name : {"s3_f1_v2.obj", "s3_f2_v2.obj", "s3_f4_v2.obj"}) folder.write(name, "");
  CHECK_THAT(failure({folder.path().string()}), Catch::Contains("s3_f3_v2.obj"));
}

TEST_CASE("two files with one number are an error; names without numbers are not") {
  const TempFolder folder;
  folder.write("a/f1.obj", "");
  folder.write("a/f01.obj", "");
  CHECK_THAT(failure({folder / "a"}), Catch::Contains("two files"));
  folder.write("b/start.obj", "");
  folder.write("b/finish.obj", "");
  CHECK(found({folder / "b"}) == Names{"finish.obj", "start.obj"});
}

TEST_CASE("a cache takes the mesh given with it, or the one of its name") {
  const TempFolder folder;
  for (const char* name : {"m/rest.obj", "m/walk.pc2", "n/walk.ply", "n/walk.mdd", "o/lone.pc2"}) {
    folder.write(name, "");
  }
  CHECK(found({folder / "m/rest.obj", folder / "m/walk.pc2"}) == Names{"rest.obj", "walk.pc2"});
  CHECK(found({folder / "m/walk.pc2", folder / "m/rest.obj"}) == Names{"rest.obj", "walk.pc2"});
  CHECK(found({folder / "m"}) == Names{"rest.obj", "walk.pc2"});
  CHECK(found({folder / "n/walk.mdd"}) == Names{"walk.ply", "walk.mdd"});
  CHECK_THAT(failure({folder / "o/lone.pc2"}), Catch::Contains("lone.obj"));
  CHECK_THAT(failure({folder / "m/walk.pc2", folder / "n/walk.mdd"}), Catch::Contains("one mesh"));
}

TEST_CASE("streams stand alone") {
  const TempFolder folder;
  folder.write("a.reeb", "");
  folder.write("b.obj", "");
  CHECK(found({folder / "a.reeb"}) == Names{"a.reeb"});
  CHECK(found({"-"}) == Names{"-"});
  CHECK_THAT(failure({folder / "a.reeb", folder / "b.obj"}), Catch::Contains("just it"));
}

TEST_CASE("what cannot be found or mixed") {
  const TempFolder folder;
  folder.write("a.obj", "");
  folder.write("b.ply", "");
  folder.write("c.txt", "");
  folder.write("empty/x.txt", "");
  CHECK_THAT(failure({folder / "none.obj"}), Catch::Contains("none.obj"));
  CHECK_THAT(failure({folder / "none*.obj"}), Catch::Contains("none*.obj"));
  CHECK_THAT(failure({folder / "none/f_%d.obj"}), Catch::Contains("none"));
  CHECK_THAT(failure({folder / "empty"}), Catch::Contains("holds no"));
  CHECK_THAT(failure({folder.path().string()}), Catch::Contains("differ in format"));
  CHECK_THAT(failure({folder / "c.txt"}), Catch::Contains("not a format"));
}

TEST_CASE("printf patterns") {
  NumberPattern pattern;
  REQUIRE(NumberPattern::parse("out/f_%04d.obj", pattern));
  CHECK(pattern.name(7) == "out/f_0007.obj");
  CHECK(pattern.name(12345) == "out/f_12345.obj");
  CHECK(pattern.matches("out/f_0007.obj"));
  CHECK(pattern.matches("out/f_12345.obj"));
  CHECK_FALSE(pattern.matches("out/f_007.obj"));
  CHECK_FALSE(pattern.matches("out/f_00007.obj"));
  CHECK_FALSE(pattern.matches("out/f_.obj"));
  CHECK_FALSE(pattern.matches("out/f_-.obj"));
  // As printf writes it.
  CHECK(pattern.name(-7) == "out/f_-007.obj");
  CHECK(pattern.matches("out/f_-007.obj"));
  CHECK_FALSE(pattern.matches("out/f_-0007.obj"));
  REQUIRE(NumberPattern::parse("%d/f_%d.obj", pattern));
  CHECK(pattern.name(1) == "%d/f_1.obj");
  REQUIRE(NumberPattern::parse("f_%d/m.obj", pattern));
  CHECK(pattern.name(1) == "f_1/m.obj");
  CHECK_FALSE(NumberPattern::parse("plain.obj", pattern));
  CHECK_FALSE(NumberPattern::parse("%d_%d.obj", pattern));
  CHECK_FALSE(NumberPattern::parse("%s.obj", pattern));
}

}  // namespace reeb::tools
