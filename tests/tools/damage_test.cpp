// Truncated and damaged `.reeb` files in every command: what is there comes, what is missing is
// said.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "bitstream/container.h"
#include "tests/tools/run_command.h"
#include "tools/command.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using nlohmann::json;

/// Twelve frames in six groups of two, and ways to break them.
class Grouped : public TempFolder {
 public:
  Grouped() {
    REQUIRE(run_reeb({"sample", "mechanism", "--length", "12", "-o", cache}).exit_code == 0);
    REQUIRE(run_reeb({"encode", cache, "-o", stream, "--group-length", "2"}).exit_code == 0);
    bytes_ = read_text(stream);
    REQUIRE(container_.parse(data(), Limits()).ok());
    REQUIRE(container_.groups.size() == 6);
  }

  /// Without what follows group `group`, from 0.
  std::string cut_after(size_t group) const {
    const GroupChunk& g = container_.groups[group];
    return write("cut.reeb", bytes_.substr(0, g.offset + g.size));
  }
  /// Without all groups.
  std::string headers_only() const {
    return write("headers.reeb", bytes_.substr(0, container_.groups[0].offset));
  }
  /// A wrong byte in group `group`, which its checksum shows.
  std::string damage(size_t group) const {
    std::string bytes = bytes_;
    const GroupChunk& g = container_.groups[group];
    bytes[g.offset + g.size / 2] ^= 1;
    return write("damaged.reeb", bytes);
  }
  /// No coefficients in group `group`, under a right checksum.
  std::string hide_damage(size_t group) const {
    std::vector<uint8_t> out;
    ContainerWriter writer(out);
    REQUIRE(writer.begin(container_.header).ok());
    REQUIRE(writer.reference(container_.references[0].header, container_.references[0].mesh).ok());
    for (size_t i = 0; i < container_.groups.size(); ++i) {
      GroupSections sections = container_.groups[i];
      if (i == group) sections.coefficients = {};
      REQUIRE(writer.group(container_.groups[i].header, sections).ok());
    }
    REQUIRE(writer.finish().ok());
    return write("hidden.reeb", std::string(out.begin(), out.end()));
  }

  const std::string cache = *this / "m.pc2";
  const std::string stream = *this / "m.reeb";

 private:
  std::span<const uint8_t> data() const {
    return {reinterpret_cast<const uint8_t*>(bytes_.data()), bytes_.size()};
  }
  std::string bytes_;
  ContainerReader container_;
};

/// Numbers of the files f_N.ply in `folder`.
std::set<int> frames_in(const TempFolder& files, const std::string& folder) {
  std::set<int> out;
  for (int i = 1; i <= 12; ++i) {
    if (std::filesystem::exists(files / (folder + "/f_" + std::to_string(i) + ".ply")))
      out.insert(i);
  }
  return out;
}

}  // namespace

TEST_CASE("a truncated file gives what is before the cut, and exit code 1") {
  const Grouped files;
  const std::string cut = files.cut_after(2);
  const std::string said = "frames 7 to 12 of 12 are damaged or cut off";
  const CommandResult decoded = run_reeb({"decode", cut, "-o", files / "d/f_%d.ply"});
  CHECK(decoded.exit_code == kExitFailed);
  CHECK_THAT(decoded.err, Contains(said) && Contains("--keep-going"));
  CHECK(frames_in(files, "d") == std::set<int>{1, 2, 3, 4, 5, 6});

  const CommandResult info = run_reeb({"info", cut, "--json"});
  CHECK(info.exit_code == kExitFailed);
  CHECK_THAT(info.err, Contains(said));
  CHECK(json::parse(info.out)["frames"] == 6);

  const CommandResult encoded = run_reeb({"encode", cut, "-o", files / "again.reeb"});
  CHECK(encoded.exit_code == kExitFailed);
  CHECK_THAT(encoded.err, Contains(said));
  CHECK(json::parse(run_reeb({"info", files / "again.reeb", "--json"}).out)["frames"] == 6);

  const CommandResult compared = run_reeb({"compare", files.cache, cut, "--json"});
  CHECK(compared.exit_code == kExitFailed);
  CHECK_THAT(compared.err, Contains(said));
  CHECK(json::parse(compared.out)["frames"] == 6);

  const CommandResult drawn = run_reeb({"picture", cut, "-o", files / "p.png", "--tile", "40"});
  CHECK(drawn.exit_code == kExitFailed);
  CHECK_THAT(drawn.err, Contains(said));
}

TEST_CASE("--keep-going takes what is there for good, and says what is not") {
  const Grouped files;
  const std::string cut = files.cut_after(0);
  const std::vector<std::vector<std::string>> commands{
      {"decode", cut, "-o", files / "d/f_%d.ply"},
      {"info", cut},
      {"encode", cut, "-o", files / "again.reeb"},
      {"compare", files.cache, cut},
      {"picture", cut, "-o", files / "p.png", "--tile", "40"}};
  for (std::vector<std::string> command : commands) {
    INFO(command[0]);
    command.push_back("--keep-going");
    const CommandResult result = run_reeb(command);
    CHECK(result.exit_code == kExitDone);
    CHECK_THAT(result.err, Contains("frames 3 to 12 of 12 are damaged or cut off"));
  }
}

TEST_CASE("one damaged group does not cost the others") {
  const Grouped files;
  for (const std::string& broken : {files.damage(3), files.hide_damage(3)}) {
    INFO(broken);
    const std::string said = "frames 7 to 8 of 12 are damaged or cut off";
    const CommandResult decoded = run_reeb({"decode", broken, "-f", "-o", files / "d/f_%d.ply"});
    CHECK(decoded.exit_code == kExitFailed);
    CHECK_THAT(decoded.err, Contains(said));
    CHECK(frames_in(files, "d") == std::set<int>{1, 2, 3, 4, 5, 6, 9, 10, 11, 12});
    // A point cache has no numbers: its frames close up.
    CHECK(run_reeb({"decode", broken, "-f", "-o", files / "d.pc2", "--keep-going"}).exit_code == 0);
    const CommandResult length = run_reeb({"compare", files / "d.pc2", files / "d.pc2", "--json"});
    CHECK(json::parse(length.out)["frames"] == 10);
    CHECK(run_reeb({"decode", broken, "-f", "-o", files / "e.pc2", "--frames", "9:12"}).exit_code ==
          kExitDone);
    CHECK(run_reeb({"decode", broken, "-f", "-o", files / "e.pc2", "--frames", "8:12"}).exit_code ==
          kExitFailed);
  }
}

TEST_CASE("what is cut off or damaged is said where no frame is lost, too") {
  const Grouped files;
  const std::string whole = read_text(files.stream);
  for (const size_t cut : {size_t{1}, size_t{20}}) {
    const std::string broken = files.write("end.reeb", whole.substr(0, whole.size() - cut));
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"decode", broken, "-f", "-o", files / "d.pc2"},
          {"encode", broken, "-f", "-o", files / "n.reeb"},
          {"info", broken},
          {"verify", broken},
          {"picture", broken, "-f", "-o", files / "p.png"},
          {"compare", files.cache, broken}}) {
      INFO(command[0]);
      const CommandResult result = run_reeb(command);
      CHECK(result.exit_code == kExitFailed);
      CHECK_THAT(result.err, Contains("the end of the file is"));
    }
    CHECK(run_reeb({"info", broken, "--keep-going"}).exit_code == kExitDone);
    const CommandResult length = run_reeb({"compare", files / "d.pc2", files / "d.pc2", "--json"});
    CHECK(json::parse(length.out)["frames"] == 12);
  }
  std::string bytes = whole;  // the boxes of the groups
  const size_t boxes = bytes.find("bnds");
  REQUIRE(boxes != bytes.npos);
  bytes[boxes + 16] ^= 1;
  const CommandResult result =
      run_reeb({"decode", files.write("boxes.reeb", bytes), "-f", "-o", files / "d.pc2"});
  CHECK(result.exit_code == kExitFailed);
  CHECK_THAT(result.err, Contains("(bnds) are damaged; the rest is good"));
}

TEST_CASE("frames of a damaged file are compared with their own") {
  const Grouped files;
  const auto figures = [&](const std::string& stream) {
    const CommandResult result =
        run_reeb({"compare", files.cache, stream, "--json", "--per-frame", "--keep-going"});
    CHECK(result.exit_code == kExitDone);
    return json::parse(result.out);
  };
  const json whole = figures(files.stream);
  const json part = figures(files.damage(1));
  REQUIRE(part["per_frame"].size() == 10);
  for (size_t i = 0; i < 10; ++i) {
    CHECK(part["per_frame"][i] == whole["per_frame"][i < 2 ? i : i + 2]);
  }
  CHECK(part["max_error_frame"].get<int>() <= 12);
}

TEST_CASE("a file of which nothing is left is said so") {
  const Grouped files;
  const std::string headers = files.headers_only();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"decode", headers, "-o", files / "x/f_%d.obj", "--keep-going"},
        {"encode", headers, "-o", files / "x.reeb", "--keep-going"},
        {"compare", files.cache, headers, "--keep-going"}}) {
    INFO(command[0]);
    const CommandResult result = run_reeb(command);
    CHECK(result.exit_code == kExitFailed);
    CHECK_THAT(result.err, Contains("no frame can be decoded") && !Contains("1 to 0"));
  }
  CHECK_FALSE(std::filesystem::exists(files / "x"));
  CHECK_FALSE(std::filesystem::exists(files / "x.reeb"));
}

TEST_CASE("verify decodes everything and writes nothing") {
  const Grouped files;
  const auto before = files.names();
  const CommandResult good = run_reeb({"verify", files.stream, files.stream});
  CHECK(good.exit_code == kExitDone);
  CHECK_THAT(good.err, Contains("good, 12 frames in 6 groups"));
  CHECK(files.names() == before);
  CHECK_THAT(run_reeb({"verify", files.cut_after(4)}).err, Contains("truncated"));
  CHECK_THAT(run_reeb({"verify", files.hide_damage(2)}).err,
             Contains("frames 5 to 6 of 12 are damaged or cut off"));
  const CommandResult bad = run_reeb({"verify", "-q", files.damage(0), files.cache, files.stream});
  CHECK(bad.exit_code == kExitFailed);
  CHECK_THAT(bad.err, Contains("damaged.reeb: bytes ") && Contains("(GRUP) are damaged") &&
                          Contains("frames 1 to 2 of 12") && Contains("m.pc2: ") &&
                          !Contains("m.reeb"));
}

}  // namespace reeb::tools
