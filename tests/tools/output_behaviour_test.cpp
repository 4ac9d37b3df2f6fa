// Where output goes: standard output, terminals, places that cannot be written.

#include <sys/ioctl.h>
#include <sys/stat.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/run_command.h"
#include "tools/command.h"
#include "tools/io/output_set.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using Catch::StartsWith;
using nlohmann::json;

class Sample : public TempFolder {
 public:
  Sample() {
    REQUIRE(run_reeb({"sample", "mechanism", "--length", "4", "-o", cache}).exit_code == 0);
    REQUIRE(run_reeb({"encode", cache, "-o", stream}).exit_code == 0);
  }
  const std::string cache = *this / "m.pc2";
  const std::string stream = *this / "m.reeb";
};

/// Standard output of the command as `open` leaves it in the new process.
CommandResult run_into(const std::vector<std::string>& arguments,
                       const std::function<int()>& open) {
  return run_reeb(arguments, "/dev/null", [&] { ::dup2(open(), STDOUT_FILENO); });
}

int open_closed_pipe() {
  int ends[2];
  if (::pipe(ends) != 0) ::_exit(97);
  ::close(ends[0]);
  return ends[1];
}

/// A terminal that somebody reads.
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    REQUIRE(master_ >= 0);
    REQUIRE(::grantpt(master_) == 0);
    REQUIRE(::unlockpt(master_) == 0);
    slave_ = ::open(::ptsname(master_), O_RDWR | O_NOCTTY | O_CLOEXEC);
    REQUIRE(slave_ >= 0);
    reader_ = std::thread([this] {
      std::array<char, 4096> bytes;
      while (::read(master_, bytes.data(), bytes.size()) > 0) {
      }
    });
  }
  ~Terminal() {
    ::close(slave_);  // which ends the reader
    reader_.join();
    ::close(master_);
  }
  int slave() const { return slave_; }

 private:
  int master_, slave_ = -1;
  std::thread reader_;
};

/// Until the other end of `pipe` has read all that is in it, two minutes at most.
void wait_until_taken(int pipe) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  int waiting = 1;
  while (::ioctl(pipe, FIONREAD, &waiting) == 0 && waiting > 0 &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

TEST_CASE("output that does not arrive is an error in every command") {
  const Sample files;
  const std::vector<std::vector<std::string>> commands{
      {"info", files.stream},
      {"info", files.stream, "--json"},
      {"info", files.stream, "--trace"},
      {"compare", files.cache, files.stream},
      {"compare", files.cache, files.stream, "--json"},
      {"encode", files.cache, "-f", "-o", files / "n.reeb", "--json"},
      {"encode", files.cache, "-o", "-"},
      {"decode", files.stream, "-o", "-"},
      {"search", files / "a.reebi", files / "m.obj"}};
  REQUIRE(run_reeb({"index", files / "m.obj", "-o", files / "a.reebi"}).exit_code == 0);
  for (const auto& command : commands) {
    INFO(command[0]);
    const CommandResult full = run_into(command, [] { return ::open("/dev/full", O_WRONLY); });
    CHECK(full.exit_code == kExitFailed);
    CHECK_THAT(full.err, Contains("reeb: standard output: cannot be written (No space left"));
    const CommandResult closed = run_into(command, open_closed_pipe);
    CHECK(closed.exit_code == kExitFailed);
    CHECK_THAT(closed.err, Contains("cannot be written (Broken pipe)"));
  }
  CHECK(run_reeb({"encode", files.cache, "-o", "/dev/full"}).exit_code == kExitFailed);
}

TEST_CASE("decode writes a point cache or one mesh to standard output") {
  const Sample files;
  REQUIRE(run_reeb({"decode", files.stream, "-o", files / "a.pc2"}).exit_code == 0);
  REQUIRE(
      run_reeb({"decode", files.stream, "-o", files / "a.mdd", "--fps", "25", "-f"}).exit_code ==
      0);
  REQUIRE(run_reeb({"decode", files.stream, "-o", files / "a.ply", "--frames", "3"}).exit_code ==
          0);
  const std::string here = files / "here";
  std::filesystem::create_directory(here);
  const auto decoded = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"decode", files.stream});
    const CommandResult result = run_reeb(more, "/dev/null", [&] {
      if (::chdir(here.c_str()) != 0) ::_exit(97);
    });
    INFO(result.err);
    CHECK(result.exit_code == kExitDone);
    CHECK(std::filesystem::is_empty(here));
    return result.out;
  };
  for (const std::string output : {"-", "/dev/stdout"}) {
    INFO(output);
    CHECK(decoded({"-o", output}) == read_text(files / "a.pc2"));
    CHECK(decoded({"-o", output, "--format", "mdd", "--fps", "25"}) == read_text(files / "a.mdd"));
    CHECK(decoded({"-o", output, "--format", "ply", "--frames", "3"}) ==
          read_text(files / "a.ply"));
    CHECK_THAT(decoded({"-o", output, "--frames", "3"}), StartsWith("v "));
  }
  const CommandResult many = run_reeb({"decode", files.stream, "-o", "-", "--format", "obj"});
  CHECK(many.exit_code == kExitUsage);
  CHECK_THAT(many.err, Contains("holds one frame, there are 4"));
}

TEST_CASE("a report is not written behind a bar") {
  const Sample files;
  const CommandResult result =
      run_reeb({"compare", files.cache, files.stream, "--progress", "always"}, "/dev/null",
               [] { ::dup2(STDERR_FILENO, STDOUT_FILENO); });
  CHECK(result.exit_code == kExitDone);
  CHECK_THAT(result.err, Contains("\r\x1b[KKG error"));
}

TEST_CASE("encode writes to standard output by any of its names") {
  const Sample files;
  for (const std::string output : {"-", "/dev/stdout"}) {
    const CommandResult result = run_reeb({"encode", files.cache, "-o", output});
    INFO(result.err);
    CHECK((result.out == read_text(files.stream)));
  }
}

TEST_CASE("--format says what a folder's files are") {
  const Sample files;
  CHECK(run_reeb({"decode", files.stream, "-o", files / "d/", "--format", "ply"}).exit_code == 0);
  CHECK(std::filesystem::exists(files / "d/frame_0004.ply"));
  CHECK(run_reeb({"decode", files.stream, "-o", files / "e/", "--format", "pc2"}).exit_code ==
        kExitUsage);
  CHECK(run_reeb({"decode", files.stream, "-o", files / "f_%d.obj", "--format", "ply"}).exit_code ==
        kExitUsage);
}

TEST_CASE("binary data do not go to a terminal without -f") {
  const Sample files;
  const Terminal terminal;
  const auto open_terminal = [&] { return terminal.slave(); };
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"encode", files.cache, "-o", "-"},
        {"decode", files.stream, "-o", "-"},
        {"decode", files.stream, "-o", "-", "--format", "ply", "--frames", "1"}}) {
    INFO(command[0]);
    const CommandResult refused = run_into(command, open_terminal);
    CHECK(refused.exit_code == kExitFailed);
    CHECK_THAT(refused.err, Contains("terminal") && Contains("-f"));
  }
  CHECK(run_into({"encode", files.cache, "-o", "-", "-f"}, open_terminal).exit_code == kExitDone);
  CHECK(run_into({"decode", files.stream, "-o", "-", "--format", "obj", "--frames", "1"},
                 open_terminal)
            .exit_code == kExitDone);
}

TEST_CASE("the output is tried before the input is read") {
  const TempFolder folder;
  const std::string file = folder.write("file", "");
  for (const std::string& where :
       {std::string("/proc/x"), file + "/x", folder / std::string(300, 'x')}) {
    for (const auto& [command, ending] : {std::pair<std::string, std::string>{"encode", ".reeb"},
                                          {"picture", ".png"},
                                          {"plot", ".svg"}}) {
      INFO(command << " " << where);
      const CommandResult result = run_reeb({command, folder / "none", "-o", where + ending});
      CHECK(result.exit_code == kExitFailed);
      CHECK_THAT(result.err, Contains("cannot be ") && !Contains("none"));
    }
  }
  CHECK(folder.names() == std::set<std::string>{"file"});
}

TEST_CASE("room on the disk is asked for") {
  const TempFolder folder;
  CHECK(check_room(folder / "a/b/x.reeb", 1).ok());
  const Status status = check_room(folder / "a/b/x.reeb", UINT64_MAX);
  CHECK(status.code() == StatusCode::kIo);
  CHECK_THAT(status.message(), Contains("x.reeb: needs") && Contains("are free"));
  CHECK(check_room("-", UINT64_MAX).ok());
  CHECK(check_room("/dev/null", UINT64_MAX).ok());
}

TEST_CASE("an encoding whose folder has gone meanwhile is kept elsewhere") {
  const Sample files;
  const std::string fifo = files / "pipe", kept = files / "kept";
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  std::filesystem::create_directory(files / "gone");
  std::filesystem::create_directory(kept);
  const std::string stream = read_text(files.stream);
  const pid_t child = start_reeb({"encode", "-", "-o", files / "gone/x.reeb"}, fifo, "/dev/null",
                                 files / "err", [&] { ::setenv("TMPDIR", kept.c_str(), 1); });
  const int input = ::open(fifo.c_str(), O_WRONLY);
  CHECK(::write(input, stream.data(), 1) == 1);
  wait_until_taken(input);  // and so the output, which is tried before that, is there
  CHECK(!std::filesystem::is_empty(files / "gone"));
  std::filesystem::remove_all(files / "gone");
  CHECK(::write(input, stream.data() + 1, stream.size() - 1) ==
        static_cast<ssize_t>(stream.size() - 1));
  ::close(input);
  CHECK(exit_code_of(child) == kExitFailed);
  CHECK_THAT(read_text(files / "err"),
             Contains("gone/x.reeb: cannot be written") && Contains("the file is kept as " + kept));
  const std::filesystem::directory_iterator found(kept);
  REQUIRE(found != std::filesystem::directory_iterator());
  CHECK(run_reeb({"verify", found->path().string()}).exit_code == kExitDone);
}

TEST_CASE("names that mean another format are refused before any work") {
  const Sample files;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"encode", files.cache, "-o", files / "b.obj"}, "reeb decode"},
      {{"encode", files.cache, "-o", files / "walk.glb"}, ".reeb"},
      {{"encode", files.cache, "-o", files / "walk"}, ".reeb"},
      {{"decode", files.stream, "-o", files / "walk.glb"}, ".obj"},
      {{"picture", files.cache, "-o", files / "p.jpg"}, ".png"},
      {{"plot", files.cache, "-o", files / "p.png"}, ".svg"}};
  const auto before = files.names();
  for (const auto& [command, hint] : wrong) {
    const CommandResult result = run_reeb(command);
    INFO(result.err);
    CHECK(result.exit_code == kExitUsage);
    CHECK_THAT(result.err, Contains(hint));
  }
  CHECK(files.names() == before);
  CHECK(run_reeb({"encode", files.cache, "-o", files / "LOUD.REEB"}).exit_code == kExitDone);
}

TEST_CASE("names that are not UTF-8 go into JSON") {
  const Sample files;
  const std::string cache = files / "geh\xe4use.pc2", stream = files / "geh\xe4use.reeb";
  std::filesystem::copy(files.cache, cache);
  std::filesystem::copy(files / "m.obj", files / "geh\xe4use.obj");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"encode", cache, "-o", stream, "--json"},
        {"compare", cache, stream, "--json"},
        {"info", stream, "--json"}}) {
    const CommandResult result = run_reeb(command);
    CHECK(result.exit_code == kExitDone);
    CHECK_THAT(json::parse(result.out).dump(), Contains("geh\xef\xbf\xbduse"));
  }
}

TEST_CASE("an MDD gets no frame rate that nobody gave") {
  const Sample files;
  const CommandResult refused = run_reeb({"decode", files.stream, "-o", files / "x.mdd"});
  CHECK(refused.exit_code == kExitFailed);
  CHECK_THAT(refused.err, Contains("--fps"));
  REQUIRE(run_reeb({"decode", files.stream, "-o", files / "x.mdd", "--fps", "30"}).exit_code == 0);
  REQUIRE(run_reeb({"encode", files / "x.mdd", "-o", files / "x.reeb"}).exit_code == 0);
  CHECK(json::parse(run_reeb({"info", files / "x.reeb", "--json"}).out)["frame_rate"] == 30);
  CHECK(json::parse(run_reeb({"info", files.stream, "--json"}).out)["frame_rate"] == 0);
}

}  // namespace reeb::tools
