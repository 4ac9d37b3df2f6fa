// The command line as its users meet it: the built program, its exit codes, its streams and its
// files.
#include "tools/command.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/mesh_file.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using nlohmann::json;
using Names = std::set<std::string>;

/// A sample sequence and its stream.
class Encoded : public TempFolder {
 public:
  Encoded() {
    REQUIRE(run_reeb({"sample", "mechanism", "--length", "6", "-o", cache}).exit_code == 0);
    const CommandResult encoded = run_reeb({"encode", cache, "-o", stream, "--kg", "0.1"});
    INFO(encoded.err);
    REQUIRE(encoded.exit_code == 0);
  }
  const std::string cache = *this / "m.pc2";
  const std::string stream = *this / "m.reeb";
};

}  // namespace

TEST_CASE("help and version") {
  const CommandResult version = run_reeb({"--version"});
  CHECK(version.exit_code == kExitDone);
  CHECK_THAT(version.out, Contains("reeb") && Contains("format version 1"));
  CHECK(run_reeb({"--help"}).exit_code == kExitDone);
  for (const char* command : {"encode", "decode", "info", "compare", "sample"}) {
    const CommandResult help = run_reeb({command, "--help"});
    CHECK(help.exit_code == kExitDone);
    CHECK_THAT(help.out, Contains("Usage"));
  }
}

TEST_CASE("wrong usage is exit code 2, before any work") {
  const TempFolder folder;
  const std::string in = folder.write("a.obj", "v 0 0 0\n");
  const std::string out = folder / "a.reeb";
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"frobnicate"},
      {"encode", in},
      {"encode", "-o", out},
      {"encode", in, "-o", out, "--kg", "0.1", "--bpvf", "1"},
      {"encode", in, "-o", out, "--kg", "-1"},
      {"encode", in, "-o", out, "--kg", "0"},
      {"encode", in, "-o", out, "--max-error", "5 miles"},
      {"encode", in, "-o", out, "--size", "many"},
      {"encode", in, "-o", out, "--size", "0.1"},
      {"encode", in, "-o", out, "--profile", "best"},
      {"encode", in, "-o", out, "--regions", "some"},
      {"encode", in, "-o", out, "--group-length", "0"},
      {"encode", in, "-o", out, "--open-groups", "64"},
      {"encode", in, "-o", out, "--open-groups", "1", "--profile", "fast"},
      {"encode", in, "-o", out, "--effort", "0"},
      {"encode", in, "-o", out, "--effort", "10"},
      {"encode", in, "-o", out, "--effort", "most"},
      {"encode", in, "-o", "-", "--json"},
      {"decode", out, "-o", folder / "b_%d.obj", "--frames", "0"},
      {"decode", out, "-o", folder / "b_%d.obj", "--frames", "1:x"},
      {"compare", in},
      {"compare", in, in, "--tolerance", "-1"},
      {"sample", "unicorn", "-o", folder / "u.pc2"},
      {"sample", "sheet", "-o", folder / "u.txt"},
  };
  for (const auto& arguments : wrong) {
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    INFO(line);
    const CommandResult result = run_reeb(arguments);
    CHECK(result.exit_code == kExitUsage);
    CHECK_FALSE(result.err.empty());
    CHECK(result.out.empty());
  }
  CHECK(folder.names() == Names{"a.obj"});
}

TEST_CASE("bad input is exit code 1, names the file and leaves nothing") {
  const TempFolder folder;
  folder.write("walk/f_1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string out = folder / "new/out.reeb";
  const auto encode_fails = [&](const std::string& input) {
    const CommandResult result = run_reeb({"encode", input, "-o", out});
    CHECK(result.exit_code == kExitFailed);
    CHECK(result.out.empty());
    CHECK_FALSE(std::filesystem::exists(folder / "new"));
    return result.err;
  };
  CHECK_THAT(encode_fails(folder / "nothing"), Contains("nothing"));
  folder.write("walk/f_2.obj", "v 0 0 nan\n");
  CHECK_THAT(encode_fails(folder / "walk"), Contains("frame 2") && Contains("f_2.obj"));
  folder.write("walk/f_2.obj", "");
  CHECK_THAT(encode_fails(folder / "walk"), Contains("empty"));
  std::filesystem::rename(folder / "walk/f_2.obj", folder / "walk/f_3.obj");
  CHECK_THAT(encode_fails(folder / "walk/*.obj"), Contains("f_2.obj") && Contains("missing"));
  CHECK(run_reeb({"info", folder / "walk/f_1.obj"}).exit_code == kExitFailed);
  CHECK(run_reeb({"decode", folder / "walk/f_1.obj", "-o", folder / "o_%d.obj"}).exit_code ==
        kExitFailed);
  CHECK(run_reeb({"info", folder / "nothing.reeb"}).exit_code == kExitFailed);
}

TEST_CASE("encode, info, decode and compare") {
  const Encoded files;
  const CommandResult info = run_reeb({"info", files.stream, "--json"});
  REQUIRE(info.exit_code == kExitDone);
  const json told = json::parse(info.out);
  CHECK(told["format_version"] == 1);
  CHECK(told["frames"] == 6);
  CHECK(told["bytes"] == std::filesystem::file_size(files.stream));
  CHECK(told["shots"].size() == 1);
  CHECK(told["shots"][0]["vertices"] == 2634);
  const double bpvf =
      8.0 * static_cast<double>(std::filesystem::file_size(files.stream)) / 2634 / 6;
  CHECK(told["bpvf"].get<double>() == Approx(bpvf));
  CHECK_THAT(run_reeb({"info", files.stream}).out, Contains("6 frames") && Contains("2,634"));

  const CommandResult traced = run_reeb({"info", files.stream, "--trace"});
  CHECK(traced.exit_code == kExitDone);
  CHECK_THAT(traced.out, Contains("total_frames"));

  const CommandResult compared = run_reeb(
      {"compare", files.cache, files.stream, "--json", "--per-frame", "--tolerance", "0.1"});
  INFO(compared.err);
  REQUIRE(compared.exit_code == kExitDone);
  const json figures = json::parse(compared.out);
  CHECK(figures["kg"].get<double>() <= 0.1);
  CHECK(figures["within_tolerance"] == true);
  CHECK(figures["per_frame"].size() == 6);
  CHECK(figures["other"]["bpvf"].get<double>() == Approx(bpvf));
  CHECK_FALSE(figures["original"].contains("bpvf"));

  // What is decoded into files is what is compared from the stream.
  REQUIRE(run_reeb({"decode", files.stream, "-o", files / "d/f_%02d.ply"}).exit_code == kExitDone);
  const CommandResult same = run_reeb({"compare", files.stream, files / "d", "--json"});
  CHECK(json::parse(same.out)["identical"] == true);
}

TEST_CASE("compare beyond a tolerance is exit code 3") {
  const TempFolder folder;
  const TestMesh mesh = plain_mesh();
  std::vector<float> moved = mesh.positions;
  moved[0] += 0.25f;
  const std::string a =
      folder.write("a.obj", write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kObj));
  const std::string b =
      folder.write("b.obj", write_mesh(mesh.connectivity, moved, MeshFormat::kObj));
  // The box of a is 1 x 1 x 0.5, its diagonal 1.5; 0.25 is 16.67 % of it.
  CHECK(run_reeb({"compare", a, b}).exit_code == kExitDone);
  CHECK(run_reeb({"compare", a, b, "--tolerance", "50"}).exit_code == kExitDone);
  CHECK(run_reeb({"compare", a, b, "--tolerance", "1"}).exit_code == kExitOverTolerance);
  CHECK(run_reeb({"compare", a, b, "--max-error", "0.26"}).exit_code == kExitDone);
  CHECK(run_reeb({"compare", a, b, "--max-error", "0.24"}).exit_code == kExitOverTolerance);
  CHECK(run_reeb({"compare", a, b, "--max-error", "16.7%"}).exit_code == kExitDone);
  CHECK(run_reeb({"compare", a, b, "--max-error", "16.6%"}).exit_code == kExitOverTolerance);
  CHECK(run_reeb({"compare", a, a, "--tolerance", "0"}).exit_code == kExitDone);

  const std::string other = folder.write("c.obj", "v 0 0 0\n");
  const CommandResult result = run_reeb({"compare", a, other});
  CHECK(result.exit_code == kExitFailed);
  CHECK_THAT(result.err, Contains("4 against 1 vertex"));
}

TEST_CASE("ranges of frames") {
  const Encoded files;
  const auto decoded = [&](const std::vector<std::string>& selection) {
    std::vector<std::string> arguments{"decode", files.stream, "-f", "-o", files / "r/f%d.obj"};
    arguments.insert(arguments.end(), selection.begin(), selection.end());
    std::filesystem::remove_all(files / "r");
    const CommandResult result = run_reeb(arguments);
    INFO(result.err);
    CHECK(result.exit_code == kExitDone);
    std::string names;
    for (int i = 1; i <= 6; ++i) {
      if (std::filesystem::exists(files / ("r/f" + std::to_string(i) + ".obj"))) {
        names += std::to_string(i);
      }
    }
    return names;
  };
  CHECK(decoded({}) == "123456");
  const std::string second = read_text(files / "r/f2.obj");
  const std::string fifth = read_text(files / "r/f5.obj");
  CHECK(second != fifth);
  CHECK(decoded({"--frames", "5:"}) == "56");
  CHECK(decoded({"--frames", ":2"}) == "12");
  CHECK(decoded({"--frames", "2:5"}) == "2345");
  CHECK(read_text(files / "r/f5.obj") == fifth);
  // Backwards counts anew.
  for (const auto& backwards : {std::vector<std::string>{"--frames", "5:2"},
                                std::vector<std::string>{"--frames", "2:5", "--reverse"}}) {
    CHECK(decoded(backwards) == "1234");
    CHECK(read_text(files / "r/f1.obj") == fifth);
    CHECK(read_text(files / "r/f4.obj") == second);
  }
  REQUIRE(run_reeb({"decode", files.stream, "--frames", "5", "-o", files / "one.obj"}).exit_code ==
          0);
  CHECK(read_text(files / "one.obj") == fifth);
  const CommandResult beyond =
      run_reeb({"decode", files.stream, "--frames", "2:7", "-o", files / "x"});
  CHECK(beyond.exit_code == kExitFailed);
  CHECK_THAT(beyond.err, Contains("frame 7 does not exist") && Contains("1 to 6"));
  CHECK_FALSE(std::filesystem::exists(files / "x"));
  CHECK(run_reeb({"decode", files.stream, "-o", files / "many.obj"}).exit_code == kExitUsage);
}

TEST_CASE("nothing is overwritten without -f") {
  const Encoded files;
  files.write("taken.reeb", "mine");
  files.write("f_3.obj", "mine");
  const CommandResult refused = run_reeb({"encode", files.cache, "-o", files / "taken.reeb"});
  CHECK(refused.exit_code == kExitFailed);
  CHECK_THAT(refused.err, Contains("taken.reeb") && Contains("-f"));
  CHECK(read_text(files / "taken.reeb") == "mine");
  const Names before = files.names();
  CHECK(run_reeb({"decode", files.stream, "-o", files / "f_%d.obj"}).exit_code == kExitFailed);
  CHECK(files.names() == before);
  CHECK(run_reeb({"encode", files.cache, "-f", "-o", files / "taken.reeb"}).exit_code == kExitDone);
  CHECK(read_text(files / "taken.reeb") != "mine");
}

TEST_CASE("a stream goes through standard input and output") {
  const Encoded files;
  const CommandResult encoded = run_reeb({"encode", files.cache, "--kg", "0.1", "-o", "-"});
  CHECK(encoded.exit_code == kExitDone);
  CHECK(encoded.out == read_text(files.stream));
  CHECK(run_reeb({"info", "-"}, files.stream).exit_code == kExitDone);
  CHECK(run_reeb({"compare", files.cache, "-"}, files.stream).exit_code == kExitDone);
  CHECK(
      run_reeb({"decode", "-", "-o", files / "back.mdd", "--fps", "25"}, files.stream).exit_code ==
      kExitDone);
  CHECK(run_reeb({"compare", files.stream, files / "back.mdd", "--tolerance", "0"}).exit_code ==
        kExitDone);
}

TEST_CASE("people read standard error, programs standard output") {
  const Encoded files;
  const auto encode_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"encode", files.cache, "-f", "-o", files / "s.reeb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_reeb(arguments);
  };
  const CommandResult plain = encode_with({});
  CHECK(plain.out.empty());
  CHECK_THAT(plain.err, Contains("bits per vertex and frame") && Contains("KG") && !Contains("["));
  const CommandResult quiet = encode_with({"-q"});
  CHECK(quiet.out.empty());
  CHECK(quiet.err.empty());
  const json report = json::parse(encode_with({"--json", "-q"}).out);
  CHECK(report["bytes"] == std::filesystem::file_size(files / "s.reeb"));
  CHECK_THAT(encode_with({"--progress", "always"}).err, Contains("100 %"));
  CHECK(encode_with({"--progress", "sometimes"}).exit_code == kExitUsage);
}

TEST_CASE("frame rate and start time come from the input or the command line") {
  const Encoded files;
  REQUIRE(run_reeb({"sample", "mechanism", "--length", "3", "-o", files / "t.mdd"}).exit_code == 0);
  REQUIRE(run_reeb({"encode", files / "t.mdd", "-o", files / "t.reeb"}).exit_code == 0);
  json info = json::parse(run_reeb({"info", files / "t.reeb", "--json"}).out);
  CHECK(info["frame_rate"] == 25);
  REQUIRE(run_reeb({"encode", files / "t.mdd", "-f", "-o", files / "t.reeb", "--fps", "30",
                    "--start", "-2.5"})
              .exit_code == 0);
  info = json::parse(run_reeb({"info", files / "t.reeb", "--json"}).out);
  CHECK(info["frame_rate"] == 30);
  CHECK(info["start_time"] == -2.5);
}

TEST_CASE("every input format goes through the codec") {
  const TempFolder folder;
  for (const std::string name :
       {"obj/f_%03d.obj", "ply/f%d.ply", "off/f_%d.off", "pc2/m.pc2", "mdd/m.mdd"}) {
    INFO(name);
    const std::string input = folder / name.substr(0, 3);
    const std::string stream = input + ".reeb";
    REQUIRE(run_reeb({"sample", "mechanism", "--length", "2", "-o", folder / name}).exit_code == 0);
    REQUIRE(run_reeb({"encode", input, "-o", stream, "--kg", "0.5"}).exit_code == kExitDone);
    CHECK(run_reeb({"compare", input, stream, "--tolerance", "0.5"}).exit_code == kExitDone);
  }
  REQUIRE(
      run_reeb({"sample", "mechanism", "--length", "2", "-o", folder / "stl/f%d.stl"}).exit_code ==
      0);
  REQUIRE(
      run_reeb({"encode", folder / "stl", "-o", folder / "stl.reeb", "--kg", "0.5"}).exit_code ==
      0);
  CHECK(
      run_reeb({"compare", folder / "stl", folder / "stl.reeb", "--tolerance", "0.5"}).exit_code ==
      0);
}

TEST_CASE("odd meshes go through the codec with all their vertices and faces") {
  for (const TestMesh& mesh : odd_meshes()) {
    // Coordinates at the limits of float32 are for readers and writers only.
    if (mesh.name == "exact floats") continue;
    INFO(mesh.name);
    const TempFolder folder;
    std::vector<float> positions = mesh.positions;
    for (const char* name : {"in/f_1.obj", "in/f_2.obj"}) {
      folder.write(name, write_mesh(mesh.connectivity, positions, MeshFormat::kObj));
      positions[4] += 0.5f;
    }
    const std::string stream = folder / "s.reeb";
    const CommandResult encoded = run_reeb({"encode", folder / "in", "-o", stream, "--kg", "0.01"});
    INFO(encoded.err);
    REQUIRE(encoded.exit_code == kExitDone);
    REQUIRE(run_reeb({"decode", stream, "-o", folder / "out/f_%d.ply"}).exit_code == kExitDone);
    const CommandResult compared =
        run_reeb({"compare", folder / "in", folder / "out", "--tolerance", "0.01"});
    INFO(compared.err);
    CHECK(compared.exit_code == kExitDone);
  }
}

TEST_CASE("a change of connectivity starts a new reference and is said") {
  const TempFolder folder;
  const TestMesh a = plain_mesh();
  const TestMesh b = odd_meshes()[0];
  folder.write("in/f_1.obj", write_mesh(a.connectivity, a.positions, MeshFormat::kObj));
  folder.write("in/f_2.obj", write_mesh(b.connectivity, b.positions, MeshFormat::kObj));
  const CommandResult encoded = run_reeb({"encode", folder / "in", "-o", folder / "s.reeb"});
  INFO(encoded.err);
  REQUIRE(encoded.exit_code == kExitDone);
  CHECK_THAT(encoded.err,
             Contains("f_2.obj: 5 vertices, frame 1 has 4; a new reference starts here"));
  CHECK(run_reeb({"compare", folder / "in", folder / "s.reeb", "--tolerance", "0.05"}).exit_code ==
        0);
  const CommandResult cache = run_reeb({"decode", folder / "s.reeb", "-o", folder / "c.pc2"});
  CHECK(cache.exit_code == kExitFailed);
  CHECK_THAT(cache.err, Contains("frame 2"));
}

TEST_CASE("a picture of one sequence or two") {
  const Encoded files;
  const std::string png = files / "p.png";
  REQUIRE(
      run_reeb({"picture", files.cache, "-o", png, "--frames", "1,6", "--tile", "60"}).exit_code ==
      kExitDone);
  CHECK(read_text(png).substr(1, 3) == "PNG");
  CHECK(run_reeb({"picture", files.cache, files.stream, "-o", png}).exit_code == kExitFailed);
  CHECK(run_reeb({"picture", files.cache, files.stream, "-f", "-o", png}).exit_code == kExitDone);
  CHECK_THAT(run_reeb({"picture", files.cache, "-f", "-o", png, "--frames", "7"}).err,
             Contains("frame 7 does not exist"));
}

TEST_CASE("a plot of a table") {
  const TempFolder folder;
  const std::string table = folder.write("r.csv", "sequence,bpvf,kg\ncow,1,0.5\ncow,2,0.2\n");
  CHECK(run_reeb({"plot", table, "-o", folder / "r.svg"}).exit_code == kExitDone);
  CHECK_THAT(read_text(folder / "r.svg"), Contains("</svg>"));
  CHECK_THAT(run_reeb({"plot", table, "-y", "psnr", "-f", "-o", folder / "r.svg"}).err,
             Contains("psnr"));
}

TEST_CASE("values with units") {
  AbsoluteOrPercent e;
  CHECK(parse_absolute_or_percent("0.25", e).empty());
  CHECK(e.of(8) == 0.25);
  CHECK(parse_absolute_or_percent("5%", e).empty());
  CHECK(e.of(8) == Approx(0.4));
  for (const char* bad : {"", "%", "-1", "0", "1%%", "nan", "inf", "1e999"}) {
    INFO(bad);
    CHECK_FALSE(parse_absolute_or_percent(bad, e).empty());
  }
  double bytes = 0;
  const auto size_of = [&](const std::string& text) {
    CHECK(parse_byte_count(text, bytes).empty());
    return bytes;
  };
  CHECK(size_of("1500") == 1500);
  CHECK(size_of("500k") == 500000);
  CHECK(size_of("1.5M") == 1500000);
  CHECK(size_of("2G") == 2e9);
  CHECK(size_of("2GB") == 2e9);
  CHECK(size_of("64KiB") == 65536);
  CHECK(size_of("2MiB") == 2097152);
  for (const char* bad : {"", "k", "0", "-5", "1.5X", "0.5"}) {
    INFO(bad);
    CHECK_FALSE(parse_byte_count(bad, bytes).empty());
  }
}

}  // namespace reeb::tools
