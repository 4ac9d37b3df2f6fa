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

TEST_CASE("numbers in names are compared by value") {
  CHECK(natural_less("f2.obj", "f10.obj"));
  CHECK_FALSE(natural_less("f10.obj", "f2.obj"));
  CHECK(natural_less("f009.obj", "f10.obj"));
  CHECK(natural_less("a2b10", "a2b11"));
  CHECK(natural_less("a", "b"));
  CHECK_FALSE(natural_less("f1", "f1"));
  // Equal in value: the order is still total.
  CHECK(natural_less("f01", "f1") != natural_less("f1", "f01"));
  CHECK(natural_less("f99999999999999999999998", "f99999999999999999999999"));
}

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
  // As a shell expands it.
  CHECK(found({folder / "f10.obj", folder / "f11.obj", folder / "f8.obj", folder / "f9.obj"}) ==
        expected);
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
  CHECK_FALSE(NumberPattern::parse("plain.obj", pattern));
  CHECK_FALSE(NumberPattern::parse("%d_%d.obj", pattern));
  CHECK_FALSE(NumberPattern::parse("%s.obj", pattern));
}

}  // namespace reeb::tools
