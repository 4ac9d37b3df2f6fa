#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <reeb.hpp>
#include <thread>

#include "tests/bindings/streams.h"

using namespace reeb::test;
using reeb::Stream;

namespace {

/// What a slow reader's function does, seen from outside of it.
struct Watch {
  std::atomic<int> inside{0}, ahead{0};
  std::atomic<int> destroyed_inside{0};  ///< must stay 0
};

/// Reads slowly on the thread that decodes ahead, and notes where it is destroyed meanwhile.
class SlowReader {
 public:
  explicit SlowReader(Watch& watch) : watch_(&watch) {}
  SlowReader(const SlowReader&) = default;
  SlowReader(SlowReader&& other) noexcept : watch_(std::exchange(other.watch_, nullptr)) {}
  ~SlowReader() {
    if (watch_ != nullptr && watch_->inside > 0) ++watch_->destroyed_inside;
  }
  bool operator()(uint64_t offset, void* buffer, size_t size) const {
    Watch& watch = *watch_;
    ++watch.inside;
    if (std::this_thread::get_id() != player_) {
      ++watch.ahead;
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    std::memcpy(buffer, tiny_stream().data() + offset, size);
    --watch.inside;
    return true;
  }

 private:
  Watch* watch_;
  std::thread::id player_ = std::this_thread::get_id();
};

/// Opens `stream` and plays until its reader runs on another thread.
void play_until_ahead(Stream& stream, Watch& watch) {
  reeb_options options = Stream::defaults();
  options.prefetch = 1;
  REQUIRE(stream.open_reader(tiny_stream().size(), SlowReader(watch), options) == REEB_OK);
  std::vector<float> positions;
  REQUIRE(stream.frame(0, positions) == REEB_OK);
  REQUIRE(stream.frame(1, positions) == REEB_OK);
  while (watch.ahead == 0) std::this_thread::yield();
}

bool plays(Stream& stream) {
  std::vector<float> positions;
  const auto wanted = tiny_frame(4);
  return stream.frame(4, positions) == REEB_OK &&
         std::equal(wanted.begin(), wanted.end(), positions.begin());
}

}  // namespace

TEST_CASE("a stream changes hands while its reader runs", "[cpp][threads]") {
  Watch first, second;
  Stream hand, next;
  play_until_ahead(hand, first);
  SECTION("assigned") {
    play_until_ahead(next, second);
    hand = std::move(next);
    CHECK(first.inside == 0);  // its decoder has ended
    CHECK(plays(hand));
    CHECK_FALSE(next);
  }
  SECTION("assigned from one that is closed") {
    hand = Stream();
    CHECK(first.inside == 0);
    CHECK_FALSE(hand);
  }
  SECTION("constructed") {
    Stream other(std::move(hand));
    CHECK_FALSE(hand);
    CHECK(plays(other));
  }
  SECTION("moved to itself") {
    Stream& same = hand;
    hand = std::move(same);
    CHECK(plays(hand));
  }
  SECTION("swapped") {
    play_until_ahead(next, second);
    swap(hand, next);
    CHECK(plays(hand));
    CHECK(plays(next));
    hand.close();
    CHECK(second.inside == 0);
    CHECK(plays(next));
  }
  SECTION("opened again") {
    play_until_ahead(hand, second);
    CHECK(first.inside == 0);
    CHECK(plays(hand));
  }
  SECTION("destroyed") {
    { const Stream last = std::move(hand); }
    CHECK(first.inside == 0);
  }
  hand.close();
  next.close();
  CHECK(first.destroyed_inside == 0);
  CHECK(second.destroyed_inside == 0);
}

TEST_CASE("a stream that could not be opened tells why", "[cpp]") {
  Stream stream;
  CHECK(stream.message().empty());
  CHECK(stream.open_memory("no such file", 12) == REEB_CORRUPT);
  CHECK_FALSE(stream.message().empty());
  char text[8];
  reeb_options options = Stream::defaults();
  options.message = text;
  options.message_size = sizeof text;
  CHECK(stream.open_reader(5, nullptr, options) != REEB_OK);
  CHECK(stream.message() == text);
  REQUIRE(stream.open_push() == REEB_OK);
  CHECK(stream.message().empty());
}

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
