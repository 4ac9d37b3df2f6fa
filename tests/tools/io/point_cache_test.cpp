#include "tools/io/point_cache.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/tools/temp_folder.h"

namespace reeb::tools {
namespace {

// Two frames of one point: (1, 2, 0.5) and (-1, 0, 4). Bytes written by hand from the formats'
// descriptions; 1.0f is 3f800000, 2.0f 40000000, 0.5f 3f000000, -1.0f bf800000, 4.0f 40800000.
const std::string kPc2(
    "POINTCACHE2\0"
    "\x01\0\0\0"
    "\x01\0\0\0"
    "\0\0\x40\x41"
    "\0\0\0\x3f"  // start frame 12, 0.5 frames per sample
    "\x02\0\0\0"
    "\0\0\x80\x3f"
    "\0\0\0\x40"
    "\0\0\0\x3f"
    "\0\0\x80\xbf"
    "\0\0\0\0"
    "\0\0\x80\x40",
    32 + 24);
const std::string kMdd(
    "\0\0\0\x02"
    "\0\0\0\x01"
    "\x3f\0\0\0"
    "\x3f\x40\0\0"  // times 0.5 and 0.75 seconds: 4 per second
    "\x3f\x80\0\0"
    "\x40\0\0\0"
    "\x3f\0\0\0"
    "\xbf\x80\0\0"
    "\0\0\0\0"
    "\x40\x80\0\0",
    16 + 24);
const std::vector<float> kPositions{1, 2, 0.5f, -1, 0, 4};

std::string failure(const TempFolder& folder, const std::string& name, const std::string& bytes) {
  PointCache cache;
  const Status status = read_point_cache(folder.write(name, bytes), cache);
  REQUIRE_FALSE(status.ok());
  CHECK_THAT(status.message(), Catch::Contains(name));
  CHECK(cache.positions.capacity() <= bytes.size());
  return status.message();
}

}  // namespace

TEST_CASE("PC2 is read and written byte for byte") {
  const TempFolder folder;
  PointCache cache;
  REQUIRE(read_point_cache(folder.write("a.pc2", kPc2), cache).ok());
  CHECK(cache.point_count == 1);
  CHECK(cache.frame_count == 2);
  CHECK(cache.start_time == 12);
  CHECK(cache.frames_per_sample == 0.5);
  CHECK(cache.frame_rate == 0);
  CHECK(cache.positions == kPositions);
  CHECK(cache_header(CacheFormat::kPc2, 1, 2, 0, 12, 0.5) +
            cache_positions(CacheFormat::kPc2, kPositions) ==
        kPc2);
}

TEST_CASE("MDD is read and written byte for byte") {
  const TempFolder folder;
  PointCache cache;
  REQUIRE(read_point_cache(folder.write("a.MDD", kMdd), cache).ok());
  CHECK(cache.point_count == 1);
  CHECK(cache.frame_count == 2);
  CHECK(cache.frame_rate == 4);
  CHECK(cache.start_time == 2);
  CHECK(cache.positions == kPositions);
  CHECK(cache_header(CacheFormat::kMdd, 1, 2, 4, 2, 1) +
            cache_positions(CacheFormat::kMdd, kPositions) ==
        kMdd);
}

TEST_CASE("usual frame rates survive the float32 times of MDD") {
  const TempFolder folder;
  for (const double rate : {24.0, 25.0, 30.0, 60.0, 24000.0 / 1001.0, 30000.0 / 1001.0, 12.5}) {
    const std::string bytes = cache_header(CacheFormat::kMdd, 1, 200, rate, 10, 1) +
                              cache_positions(CacheFormat::kMdd, std::vector<float>(600));
    PointCache cache;
    REQUIRE(read_point_cache(folder.write("r.mdd", bytes), cache).ok());
    CHECK(cache.frame_rate == Approx(rate).epsilon(1e-6));
    CHECK(cache.start_time == Approx(10));
    CHECK(cache.notes.empty());
  }
}

TEST_CASE("uneven MDD times are reported") {
  const TempFolder folder;
  std::string bytes = cache_header(CacheFormat::kMdd, 1, 4, 10, 0, 1) +
                      cache_positions(CacheFormat::kMdd, std::vector<float>(12));
  bytes[13] = '\x01';  // the second time
  PointCache cache;
  REQUIRE(read_point_cache(folder.write("u.mdd", bytes), cache).ok());
  CHECK(cache.notes.size() == 1);
}

TEST_CASE("what of a header is not used is told") {
  const TempFolder folder;
  std::string times = kPc2;
  times.replace(20, 8, "\0\0\xc0\x7f\0\0\x80\xbf", 8);  // start NaN, -1 frames per sample
  PointCache cache;
  REQUIRE(read_point_cache(folder.write("a.pc2", times + "more"), cache).ok());
  CHECK(cache.start_time == 0);
  CHECK(cache.frames_per_sample == 1);
  REQUIRE(cache.notes.size() == 3);
  CHECK_THAT(cache.notes[0], Catch::Contains("a.pc2: the start frame is no number"));
  CHECK_THAT(cache.notes[1], Catch::Contains("frames per sample are -1"));
  CHECK_THAT(cache.notes[2], Catch::Contains("4 bytes behind the last frame"));

  std::string still = kMdd;
  still.replace(12, 4, still.substr(8, 4));
  REQUIRE(read_point_cache(folder.write("a.mdd", still), cache).ok());
  CHECK(cache.frame_rate == 0);
  REQUIRE(cache.notes.size() == 1);
  CHECK_THAT(cache.notes[0], Catch::Contains("do not increase"));
}

TEST_CASE("every cut of a cache is an error, and lying counts take no memory") {
  const TempFolder folder;
  for (size_t size = 0; size < kPc2.size(); ++size) failure(folder, "c.pc2", kPc2.substr(0, size));
  for (size_t size = 0; size < kMdd.size(); ++size) failure(folder, "c.mdd", kMdd.substr(0, size));
  CHECK_THAT(failure(folder, "c.pc2", kPc2.substr(0, 50)), Catch::Contains("frame 2 is missing"));

  std::string pc2 = kPc2;
  pc2.replace(16, 4, "\xff\xff\xff\xff");
  pc2.replace(28, 4, "\xff\xff\xff\xff");
  failure(folder, "huge.pc2", pc2);
  failure(folder, "huge.mdd", "\xff\xff\xff\xff\xff\xff\xff\xff" + kMdd.substr(8));
}

TEST_CASE("caches with wrong content") {
  const TempFolder folder;
  CHECK_THAT(failure(folder, "x.pc2", "garbage"), Catch::Contains("not a PC2"));
  std::string version = kPc2;
  version[12] = 2;
  CHECK_THAT(failure(folder, "v.pc2", version), Catch::Contains("version 2"));
  std::string none = kPc2;
  none[28] = 0;
  CHECK_THAT(failure(folder, "n.pc2", none), Catch::Contains("no frames"));

  std::string nan = kPc2;
  nan.replace(32 + 16, 4, "\0\0\xc0\x7f", 4);
  PointCache cache;
  const Status status = read_point_cache(folder.write("nan.pc2", nan), cache);
  CHECK_THAT(status.message(), Catch::Contains("frame 2, vertex 1 is not finite"));
}

}  // namespace reeb::tools
