#include "tools/io/read_sequence.h"

#include <catch2/catch.hpp>

#include "tests/tools/temp_folder.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/mesh_file.h"
#include "tools/io/point_cache.h"

namespace reeb::tools {
namespace {

/// Frames of a mesh, the first coordinate of frame t (from 1) being t.
void write_frames(const TempFolder& folder, const TestMesh& mesh, int first, int last,
                  const std::string& extension = ".obj") {
  for (int t = first; t <= last; ++t) {
    std::vector<float> positions = mesh.positions;
    positions[0] = static_cast<float>(t);
    const std::string name = "f_" + std::to_string(t) + extension;
    folder.write(name, write_mesh(mesh.connectivity, positions, *mesh_format(name)));
  }
}

Status read(const TempFolder& folder, Sequence& out, ReadReport& report, unsigned threads = 2) {
  return read_sequence({folder.path().string()}, {.threads = threads}, out, report);
}

}  // namespace

TEST_CASE("frames of one connectivity are one shot, whatever the threads") {
  for (const char* extension : {".obj", ".ply", ".off"}) {
    for (const unsigned threads : {1u, 3u}) {
      const TempFolder folder;
      write_frames(folder, odd_meshes()[2], 1, 60, extension);
      Sequence sequence;
      ReadReport report;
      REQUIRE(read(folder, sequence, report, threads).ok());
      REQUIRE(sequence.shots.size() == 1);
      CHECK(sequence.shots[0].connectivity == odd_meshes()[2].connectivity);
      REQUIRE(sequence.frame_count() == 60);
      for (uint32_t t = 0; t < 60; ++t) {
        CHECK(sequence.shots[0].frame(t)[0] == static_cast<float>(t + 1));
      }
      CHECK(report.notes.empty());
    }
  }
}

TEST_CASE("a new shot starts where vertices or faces change, also twice in a batch and back") {
  const TempFolder folder;
  const TestMesh plain = plain_mesh();
  const TestMesh more = odd_meshes()[0];
  const TestMesh turned = test_mesh("turned", square(), {{1, 2, 0}, {0, 2, 3}});
  write_frames(folder, plain, 1, 5);
  write_frames(folder, more, 6, 7);
  write_frames(folder, plain, 8, 9);
  write_frames(folder, turned, 10, 50);
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  REQUIRE(sequence.shots.size() == 4);
  CHECK(sequence.shots[0].frame_count == 5);
  CHECK(sequence.shots[1].frame_count == 2);
  CHECK(sequence.shots[2].frame_count == 2);
  CHECK(sequence.shots[3].frame_count == 41);
  CHECK(sequence.shots[1].connectivity == more.connectivity);
  CHECK(sequence.shots[2].connectivity == plain.connectivity);
  CHECK(sequence.shots[3].connectivity == turned.connectivity);
  CHECK(sequence.shots[3].frame(40)[0] == 50);
  REQUIRE(report.notes.size() == 3);
  CHECK_THAT(report.notes[0],
             Catch::EndsWith("f_6.obj: 5 vertices, frame 1 has 4; a new reference starts here"));
  CHECK_THAT(report.notes[2], Catch::Contains("the faces differ from frame 8"));
}

TEST_CASE("a bad frame is named by file and number") {
  const TempFolder folder;
  write_frames(folder, plain_mesh(), 1, 30);
  Sequence sequence;
  ReadReport report;
  const auto message = [&](const std::string& content) {
    folder.write("f_17.obj", content);
    const Status status = read(folder, sequence, report);
    REQUIRE_FALSE(status.ok());
    CHECK_THAT(status.message(), Catch::Contains("frame 17") && Catch::Contains("f_17.obj"));
    return status.message();
  };
  CHECK_THAT(message("v 0 nan 0\n"), Catch::Contains("not a finite"));
  CHECK_THAT(message(""), Catch::Contains("no vertices") && Catch::Contains("leave it out"));
  CHECK_THAT(message("v 0 0 0\nf 1 2 3\n"), Catch::Contains("uses vertex 2"));
  std::filesystem::remove(folder / "f_17.obj");
  CHECK_THAT(read(folder, sequence, report).message(),
             Catch::Contains("f_17.obj: frame 17 is missing"));
  std::filesystem::create_directory(folder / "f_17.obj");
  CHECK_THAT(read(folder, sequence, report).message(), Catch::Contains("cannot be read"));
}

TEST_CASE("what is not kept is said once, and of further frames what is new") {
  const TempFolder folder;
  folder.write("f1.obj", "v 0 0 0\nf 1 1 1\np 1\n");
  folder.write("f2.obj", "v 0 0 1\nf 1 1 1\np 1\n");
  folder.write("f3.obj", "v 0 0 1\nf 1 1 1\np 1\nl 1 1\n");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  REQUIRE(report.notes.size() == 2);
  CHECK_THAT(report.notes[0], Catch::EndsWith("f1.obj: not kept: points (1)"));
  CHECK_THAT(report.notes[1], Catch::EndsWith("f3.obj: not kept: lines (1)"));
}

TEST_CASE("bytes behind the end are told once for all files") {
  const TempFolder folder;
  const TestMesh mesh = plain_mesh();
  const std::string bytes = write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly);
  for (int t = 1; t <= 12; ++t) folder.write(std::to_string(t) + ".ply", bytes + "more");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  REQUIRE(report.notes.size() == 2);
  CHECK_THAT(report.notes[0], Catch::Contains("1.ply: 4 bytes behind"));
  CHECK_THAT(report.notes[1], Catch::Contains("11 further files"));
}

TEST_CASE("what binary32 does not hold is told and kept apart") {
  const TempFolder folder;
  folder.write("f1.obj", "v 0 0 0\nv 4 3 0\nf 1 1 2\n");
  folder.write("f2.obj", "v 0 0 0\nv 16777217 3 0\nf 1 1 2\n");
  folder.write("f3.obj", "v 0 0 0\nv 4 3 0\nv 1 1 1\nf 1 1 2\n");
  folder.write("f4.obj", "v 0 0 0\nv 4 3 0\nv 16777216.5 1 1\nf 1 1 2\n");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  CHECK(report.largest_remainder == 1);
  const Remainders expected{{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0},
                            {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0}};
  CHECK(report.remainders == expected);
  CHECK_THAT(report.notes.back(),
             Catch::Contains("f2.obj: binary32 does not hold") && Catch::Contains("by up to 1 ("));
}

TEST_CASE("what the mesh beside a cache has is kept, or it is said") {
  const TempFolder folder;
  folder.write("walk.obj", "v 0 0 0\nvn 0 0 1\nf 1//1 1//1 1//1\nl 1 1\n");
  folder.write("walk.pc2", cache_header(CacheFormat::kPc2, 1, 1, 0, 0, 1) + std::string(12, '\0'));
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Catch::EndsWith("walk.obj: not kept: lines (1)"));
  REQUIRE(sequence.shots[0].attributes.size() == 1);
  CHECK(sequence.shots[0].attributes[0].name == "vn");
}

TEST_CASE("a mesh and a cache") {
  const TempFolder folder;
  const TestMesh mesh = plain_mesh();
  folder.write("rest.ply", write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly));
  std::vector<float> frames(3 * 12);
  for (size_t i = 0; i < frames.size(); ++i) frames[i] = static_cast<float>(i);
  folder.write("walk.pc2", cache_header(CacheFormat::kPc2, 4, 3, 0, 5, 2) +
                               cache_positions(CacheFormat::kPc2, frames));
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  REQUIRE(sequence.shots.size() == 1);
  CHECK(sequence.shots[0].connectivity == mesh.connectivity);
  CHECK(sequence.shots[0].positions == frames);
  CHECK(sequence.start_time == 5);
  CHECK(sequence.metadata.at(kSampleRateKey) == "2");

  folder.write("walk.pc2", cache_header(CacheFormat::kPc2, 2, 6, 0, 5, 2) +
                               cache_positions(CacheFormat::kPc2, frames));
  const Status status = read(folder, sequence, report);
  CHECK_THAT(status.message(), Catch::Contains("2 points") && Catch::Contains("has 4 vertices"));
}

TEST_CASE("one mesh is a sequence of one frame") {
  const TempFolder folder;
  write_frames(folder, plain_mesh(), 3, 3, ".stl");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read(folder, sequence, report).ok());
  CHECK(sequence.frame_count() == 1);
}

TEST_CASE("a stream that is none") {
  const TempFolder folder;
  const std::string path = folder.write("x.reeb", "certainly not a stream");
  Sequence sequence;
  ReadReport report;
  const Status status = read_sequence({path}, {}, sequence, report);
  CHECK_FALSE(status.ok());
  CHECK_THAT(status.message(), Catch::Contains("x.reeb"));
}

}  // namespace reeb::tools
