#include <catch2/catch.hpp>

#include "test_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

bool contains(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

}  // namespace

TEST_CASE("the trace shows chunks and fields with their offsets", "[trace]") {
  const Bytes file = two_shot_file();
  const std::string lines = trace(file);
  CHECK(contains(lines, "0 signature"));
  CHECK(contains(lines, "7 format_version 1"));
  CHECK(contains(lines, "8 HEAD payload 7 bytes"));
  CHECK(contains(lines, "13   total_frames 10"));
  CHECK(contains(lines, "15   frame_rate 24"));
  CHECK(contains(lines, "20   crc right"));
  CHECK(lines.find("  key \"name\"") != std::string::npos);
  CHECK(lines.find("  quantization_step 0.25\n") != std::string::npos);
  CHECK(lines.find("  vertex_count 6\n") != std::string::npos);
  CHECK(lines.find("trailer, seek chunk ") != std::string::npos);
  CHECK(lines.find('!') == std::string::npos);
}

TEST_CASE("the trace of a damaged file goes as far as it can", "[trace]") {
  Bytes file = two_shot_file();
  file[14] = 0;  // shot_count
  const std::string lines = trace(file);
  CHECK(lines.find("!   HEAD: shot_count is out of range: 0\n") != std::string::npos);
  CHECK(contains(lines, "20   crc WRONG"));
  CHECK(lines.find("GRUP payload") != std::string::npos);
  file.resize(30);
  CHECK(trace(file).find("! 6 bytes after the last whole chunk\n") != std::string::npos);
  CHECK(trace(Bytes(3)).find('!') == 0);
}

TEST_CASE("text in a trace cannot break its lines", "[trace]") {
  Bytes file;
  ContainerWriter writer(file);
  REQUIRE(writer.begin(SequenceHeader{}).ok());
  REQUIRE(writer.metadata({{"a\nb", "\x1b[2J\"\\"}}).ok());
  const std::string lines = trace(file);
  CHECK(lines.find(R"(key "a\x0ab")") != std::string::npos);
  CHECK(lines.find(R"(value "\x1b[2J\x22\x5c")") != std::string::npos);
}
