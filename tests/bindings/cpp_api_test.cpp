#include <catch2/catch.hpp>
#include <cstring>
#include <reeb.hpp>

#include "tests/bindings/streams.h"

using namespace reeb::test;
using reeb::Stream;

TEST_CASE("a stream owns its decoder", "[cpp]") {
  Stream stream;
  CHECK_FALSE(stream);
  REQUIRE(stream.open_memory(tiny_stream().data(), tiny_stream().size()) == REEB_OK);
  Stream other = std::move(stream);
  CHECK_FALSE(stream);
  REQUIRE(other);
  CHECK(other.info().frame_count == 8);
  CHECK(other.shot(1).first_frame == 6);
  CHECK(other.group(2).first_frame == 6);
  CHECK(other.metadata("name") == "tiny");
  CHECK(other.metadata("none").empty());
  std::vector<float> positions, normals;
  for (uint32_t frame = 0; frame < 8; ++frame) {
    REQUIRE(other.frame(frame, positions, &normals) == REEB_OK);
    const auto wanted = tiny_frame(frame);
    CHECK(std::equal(wanted.begin(), wanted.end(), positions.begin()));
  }
  REQUIRE(other.between(0.5, positions) == REEB_OK);
  CHECK(other.stats().frames == 9);
  CHECK(other.position_of_time(0.04, false) == 1);
  CHECK(other.frame(8, positions) == REEB_INVALID_ARGUMENT);
  CHECK(other.message() == "frame 9 is past the end");
  other.close();
  CHECK_FALSE(other);
}

TEST_CASE("a stream reads through a function and takes pushed bytes", "[cpp]") {
  const Bytes& bytes = tiny_stream();
  Stream stream;
  const auto read_at = [&](uint64_t offset, void* buffer, size_t size) {
    std::memcpy(buffer, bytes.data() + offset, size);
    return true;
  };
  std::vector<float> positions;
  REQUIRE(stream.open_reader(bytes.size(), read_at) == REEB_OK);
  CHECK(stream.frame(4, positions) == REEB_OK);
  REQUIRE(stream.open_push() == REEB_OK);
  REQUIRE(stream.push(bytes.data(), bytes.size()) == REEB_OK);
  REQUIRE(stream.push_end() == REEB_OK);
  CHECK(stream.frame(4, positions) == REEB_OK);
  reeb::IndexView triangles, sizes, corners;
  REQUIRE(stream.triangles(0, triangles) == REEB_OK);
  CHECK(triangles.size == 3 * 96);
  REQUIRE(stream.polygons(7, sizes, corners) == REEB_OK);
  size_t sum = 0;
  for (const uint32_t size : sizes) sum += size;
  CHECK(sum == corners.size);
}
