#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tools/archive/shape_archive.h"
#include "tools/archive/shape_source.h"

namespace reeb::tools {
namespace {

retrieval::Signature signature_of(float value) {
  retrieval::Signature s;
  s.heat.assign(retrieval::kSpectralValues, value);
  s.wave.assign(retrieval::kSpectralValues, value);
  s.thickness.assign(retrieval::kBodyValues, value);
  s.straightness.assign(retrieval::kBodyValues, 0.5f);
  s.curvature.assign(retrieval::kBodyValues, value);
  s.reach.assign(retrieval::kBodyValues, value);
  return s;
}

ShapeArchive three_shapes() {
  ShapeArchive archive;
  archive.files = {{"/a.obj", 10, 20, {{1, signature_of(0)}}},
                   {"/b.obj", 11, -21, {{1, signature_of(3)}, {7, signature_of(1)}}},
                   {"/c.obj", 12, 22, {{1, signature_of(2)}}}};
  return archive;
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(path.filename().string());
  return names;
}

}  // namespace

TEST_CASE("archives come back from both of their forms") {
  const TempFolder folder;
  for (const std::string name : {"x.json", "x.reebi"}) {
    const std::string file = folder.write(name, write_archive(three_shapes(), name));
    ShapeArchive back;
    REQUIRE(read_archive(file, back).ok());
    REQUIRE(back.files.size() == 3);
    CHECK(back.files[1].path == "/b.obj");
    CHECK(back.files[1].size == 11);
    CHECK(back.files[1].modified == -21);
    REQUIRE(back.files[1].shapes.size() == 2);
    CHECK(back.files[1].shapes[1].frame == 7);
    CHECK(back.files[1].shapes[0].signature.heat == signature_of(3).heat);
  }
}

TEST_CASE("what is no archive is refused") {
  const TempFolder folder;
  const std::string good = write_archive(three_shapes(), "x.json");
  ShapeArchive out;
  for (
      const std::string& bytes :
      {std::string("[]"), std::string("{"), std::string(), good.substr(0, good.size() / 2),
       std::string(R"({"format":"reeb shape archive","version":1,"files":[{"path":"a"}]})"),
       std::string(
           R"({"format":"reeb shape archive","version":1,"files":[{"path":"a","size":1,"modified":1,"shapes":[{"frame":1,"signature":"01zz"}]}]})")}) {
    const Status status = read_archive(folder.write("x.json", bytes), out);
    CHECK(status.code() == StatusCode::kCorrupt);
    CHECK(status.message().find("x.json") != std::string::npos);
  }
  CHECK_FALSE(read_archive(folder / "none.json", out).ok());
}

TEST_CASE("lists in lists without end are no archive", "[hostile]") {
  ShapeArchive out;
  CHECK(parse_archive(std::string(1000000, '['), "x.json", out).code() == StatusCode::kCorrupt);
  for (const char list_of_one : {'\x81', '\x9f'})
    CHECK(parse_archive(std::string(1000000, list_of_one), "x.reebi", out).code() ==
          StatusCode::kCorrupt);
  CHECK(parse_archive("\x9b\x7f\xff\xff\xff\xff\xff\xff\xff", "x.reebi", out).code() ==
        StatusCode::kCorrupt);
}

TEST_CASE("results are ranked by the frame that is most alike") {
  const auto results = search_archive(three_shapes(), signature_of(0.9f), RankBy::kAll, 2);
  REQUIRE(results.size() == 2);
  CHECK(results[0].file == 1);
  CHECK(results[0].frame == 7);
  CHECK(results[1].file == 0);
  CHECK(ranked_distance(results[0].distance, RankBy::kSpectrum) <
        ranked_distance(results[1].distance, RankBy::kSpectrum));
}

TEST_CASE("shapes are found in folders, and the mesh of a cache is none") {
  const TempFolder folder;
  for (const char* name : {"b/x.obj", "a.OFF", "b/c/y.pc2", "b/c/y.obj", "z.reeb", "readme.txt"})
    folder.write(name, "");
  std::vector<std::filesystem::path> files;
  REQUIRE(find_shape_files({folder.path().string(), folder / "z.reeb"}, files).ok());
  CHECK(names_of(files) == std::vector<std::string>{"a.OFF", "y.pc2", "x.obj", "z.reeb"});
  CHECK_FALSE(find_shape_files({folder / "readme.txt"}, files).ok());
  CHECK_FALSE(find_shape_files({folder / "none"}, files).ok());
}

TEST_CASE("signatures come back from metadata, and nothing else does") {
  const std::vector<SignedFrame> frames{{1, signature_of(1)}, {12, signature_of(2)}};
  const std::string text = stored_signatures(frames);
  std::vector<SignedFrame> back;
  REQUIRE(parse_stored(text, back));
  REQUIRE(back.size() == 2);
  CHECK(back[1].frame == 12);
  CHECK(back[1].signature.wave == signature_of(2).wave);
  std::string frame_zero = text, no_colon = text;
  frame_zero[0] = '0';
  no_colon.erase(1, 1);
  const std::vector<std::string> bad_texts{
      {}, "1:", "x:0101", frame_zero, no_colon, text.substr(0, text.size() - 2), text + "0"};
  for (const std::string& bad : bad_texts) {
    std::vector<SignedFrame> none;
    CHECK_FALSE(parse_stored(bad, none));
  }
}

TEST_CASE("index and search find a shape in another pose") {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "shapes");
  for (const char* kind : {"human-1", "octopus-1", "glasses-1"}) {
    REQUIRE(
        run_reeb({"sample", kind, "--length", "1", "-o", (folder / "shapes/") + kind + "_%d.off"})
            .exit_code == 0);
  }
  REQUIRE(
      run_reeb({"sample", "octopus-1", "--length", "2", "-o", folder / "query_%d.off"}).exit_code ==
      0);
  const std::string archive = folder / "shapes.reebi";
  const CommandResult first = run_reeb({"index", folder / "shapes", "-o", archive});
  CHECK(first.exit_code == 0);
  CHECK(first.err.find("3 signed now") != std::string::npos);
  const CommandResult again =
      run_reeb({"index", folder / "shapes", folder / "query_1.off", "-o", archive});
  CHECK(again.err.find("1 signed now, 3 unchanged") != std::string::npos);

  const CommandResult found = run_reeb({"search", archive, folder / "query_2.off", "--json", "-k",
                                        "2", "--png", folder / "found.png"});
  REQUIRE(found.exit_code == 0);
  const auto results = nlohmann::json::parse(found.out)["results"];
  REQUIRE(results.size() == 2);
  for (const auto& result : results) {
    const bool octopus = result["file"].get<std::string>().find("octopus") != std::string::npos ||
                         result["file"].get<std::string>().find("query_1") != std::string::npos;
    CHECK(octopus);
    CHECK(result["score"].get<double>() > 30);
  }
  CHECK(read_text(folder / "found.png").substr(1, 3) == "PNG");
  CHECK(run_reeb({"search", archive, folder / "query_2.off", "--frame", "5"}).exit_code != 0);
  CHECK(run_reeb({"index", folder / "shapes", "-o", folder / "x.txt"}).exit_code == 2);

  REQUIRE(
      run_reeb({"encode", folder / "query_2.off", "--signature", "-o", folder / "shapes/kept.reeb"})
          .exit_code == 0);
  CHECK(run_reeb({"index", folder / "shapes", "-o", archive}).err.find("1 signed now") !=
        std::string::npos);
  const CommandResult kept = run_reeb({"search", archive, folder / "query_2.off", "-k", "1"});
  CHECK(kept.out.find("kept.reeb") != std::string::npos);
  folder.write("shapes/broken.off", "OFF\n1 1 0\n0 0 0\n3 0 0 0\n");
  std::filesystem::copy_file(folder / "query_1.off", folder / "shapes/one_more.off");
  const CommandResult broken = run_reeb({"index", folder / "shapes", "-o", archive});
  CHECK(broken.exit_code == 1);
  CHECK(broken.err.find("broken.off") != std::string::npos);
  std::filesystem::remove(folder / "shapes/broken.off");
  const CommandResult after = run_reeb({"index", folder / "shapes", "-o", archive});
  CHECK(after.exit_code == 0);
  CHECK(after.err.find("0 signed now, 5 unchanged") != std::string::npos);
}

TEST_CASE("a file that keeps its signature is indexed without being decoded") {
  const TempFolder folder;
  REQUIRE(run_reeb({"sample", "octopus-1", "--length", "2", "-o", folder / "a_%d.off"}).exit_code ==
          0);
  const std::string kept = folder / "kept.reeb", archive = folder / "kept.reebi";
  REQUIRE(run_reeb({"encode", folder / "a_1.off", folder / "a_2.off", "--signature", "-o", kept})
              .exit_code == 0);
  // Frames are damaged, and nothing else.
  std::string bytes = read_text(kept);
  bytes[bytes.find("GRUP") + 8] ^= 0x55;
  folder.write("kept.reeb", bytes);
  CHECK(run_reeb({"decode", kept, "-o", folder / "back.pc2"}).exit_code == 1);
  CHECK(run_reeb({"index", kept, "-o", archive}).exit_code == 0);
  const CommandResult found = run_reeb({"search", archive, folder / "a_2.off", "--json"});
  REQUIRE(found.exit_code == 0);
  CHECK(nlohmann::json::parse(found.out)["results"][0]["score"].get<double>() > 90);
}

TEST_CASE("what has no surface is named, and the rest is indexed", "[hostile]") {
  const TempFolder folder;
  folder.write("cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n");
  folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  REQUIRE(run_reeb({"sample", "vase-1", "--length", "1", "-o", folder / "good_%d.off"}).exit_code ==
          0);
  const std::string archive = folder / "x.json";
  const CommandResult result = run_reeb({"index", folder.path().string(), "-o", archive});
  CHECK(result.exit_code == 1);
  for (const char* name : {"cloud.obj", "flat.obj", "one.obj"})
    CHECK(result.err.find(std::string(name) + ": no surface that could be signed") !=
          std::string::npos);
  CHECK(result.err.find("1 signed now, 0 unchanged, 3 failed") != std::string::npos);
  const CommandResult found = run_reeb({"search", archive, folder / "one.obj"});
  CHECK(found.exit_code == 1);
  CHECK(found.err.find("one.obj: no surface") != std::string::npos);
}

}  // namespace reeb::tools
