#include <reeb.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <climits>
#include <cstring>
#include <map>
#include <random>
#include <thread>

#include "bitstream/container.h"
#include "tests/bindings/streams.h"

using namespace reeb::test;

extern "C" int use_reeb_from_c(const void* bytes, size_t size);

namespace {

template <class Struct>
Struct sized() {
  Struct out = {};
  out.struct_size = sizeof out;
  return out;
}

struct Closing {
  void operator()(reeb_decoder* d) const { reeb_close(d); }
};
using Handle = std::unique_ptr<reeb_decoder, Closing>;

Handle open_tiny(const reeb_options* options = nullptr) {
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_memory(tiny_stream().data(), tiny_stream().size(), options, &d) == REEB_OK);
  return Handle(d);
}

/// Room for a frame, with a pattern in front, between and behind.
struct Canvas {
  static constexpr size_t kStride = 5;
  static constexpr float kUntouched = -77.0f;
  std::vector<float> floats = std::vector<float>(48 * kStride + 8, kUntouched);
  reeb_target target = sized<reeb_target>();

  Canvas() {
    target.positions = floats.data() + 4;
    target.position_stride = kStride;
    target.vertex_capacity = 48;
  }
  bool shows(std::span<const float> frame) const {
    std::vector<float> wanted(floats.size(), kUntouched);
    for (size_t i = 0; i < frame.size(); ++i) wanted[4 + i / 3 * kStride + i % 3] = frame[i];
    return wanted == floats;
  }
};

bool gives(reeb_decoder* d, uint32_t frame) {
  Canvas canvas;
  return reeb_get_frame(d, frame, &canvas.target) == REEB_OK && canvas.shows(tiny_frame(frame));
}

struct FileOf {
  const Bytes* bytes;
  std::atomic<int> calls_now{0};
  std::atomic<bool> overlapped{false};
  bool broken = false;

  static int read_at(void* user, uint64_t offset, void* buffer, size_t size) {
    auto& file = *static_cast<FileOf*>(user);
    if (++file.calls_now > 1) file.overlapped = true;
    const bool fits = offset + size <= file.bytes->size();
    if (fits) std::memcpy(buffer, file.bytes->data() + offset, size);
    --file.calls_now;
    return fits && !file.broken ? 0 : 1;
  }
};

struct Arena {
  std::atomic<int64_t> blocks{0};
  std::atomic<int64_t> left{INT64_MAX};  ///< allocations until they fail

  reeb_allocator allocator() {
    return {[](void* user, size_t size) -> void* {
              auto& arena = *static_cast<Arena*>(user);
              if (--arena.left < 0) return nullptr;
              ++arena.blocks;
              return std::malloc(size);
            },
            [](void* user, void* block) {
              --static_cast<Arena*>(user)->blocks;
              std::free(block);
            },
            this};
  }
};

}  // namespace

TEST_CASE("the header works in plain C", "[c]") {
  CHECK(use_reeb_from_c(tiny_stream().data(), tiny_stream().size()) == 0);
}

TEST_CASE("every result has a name of its own", "[c]") {
  std::map<std::string, int> names;
  for (int r = REEB_OK; r <= REEB_NEED_MORE_DATA; ++r) ++names[reeb_result_string(r)];
  CHECK(names.size() == 10);
  for (const int none : {REEB_NEED_MORE_DATA + 1, -1, 16, INT_MAX, INT_MIN})
    CHECK(std::string(reeb_result_string(none)) == "unknown result");
}

TEST_CASE("a failed opening tells why", "[c]") {
  std::string logged;
  char text[64];
  reeb_options options = sized<reeb_options>();
  options.log = [](void* user, reeb_log_level, const char* message) {
    *static_cast<std::string*>(user) = message;
  };
  options.log_user = &logged;
  options.message = text;
  options.message_size = sizeof text;
  const auto told = [&](reeb_result result, reeb_result wanted) {
    CHECK(result == wanted);
    CHECK(logged.substr(0, options.message_size - 1) == text);
    return logged;
  };
  reeb_decoder* d = nullptr;
  const Bytes& bytes = tiny_stream();
  const reeb_reader broken = {bytes.size(), [](void*, uint64_t, void*, size_t) { return 1; },
                              nullptr};
  CHECK(told(reeb_open_memory("no such file", 12, &options, &d), REEB_CORRUPT) != "");
  CHECK(told(reeb_open_memory(bytes.data(), 9, &options, &d), REEB_TRUNCATED) != "");
  CHECK(told(reeb_open_memory(nullptr, 9, &options, &d), REEB_INVALID_ARGUMENT) == "no bytes");
  CHECK(told(reeb_open_reader(nullptr, &options, &d), REEB_INVALID_ARGUMENT) == "no reader");
  CHECK(told(reeb_open_push(&options, nullptr), REEB_INVALID_ARGUMENT) ==
        "no place for the decoder");
  CHECK_THAT(told(reeb_open_reader(&broken, &options, &d), REEB_IO), Catch::Contains("callback"));
  options.message_size = 4;
  CHECK(told(reeb_open_reader(nullptr, &options, &d), REEB_INVALID_ARGUMENT) == "no reader");
  CHECK(std::string(text) == "no ");
  options.message_size = 0;
  CHECK(reeb_open_reader(nullptr, &options, &d) == REEB_INVALID_ARGUMENT);
  options.message_size = sizeof text;
  REQUIRE(reeb_open_push(&options, &d) == REEB_OK);
  CHECK(std::string(text).empty());
  reeb_close(d);
}

TEST_CASE("a shot with gaps tells its frames and its end", "[c]") {
  // Groups of frames 0-2, 3-5 and 6-7; the first one is damaged.
  Bytes bytes = tiny_stream();
  reeb::ContainerReader container;
  REQUIRE(container.parse(bytes, reeb::Limits()).ok());
  const reeb::GroupChunk& first = container.groups[0];
  bytes[first.offset + first.size / 2] ^= 1;
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_memory(bytes.data(), bytes.size(), nullptr, &d) == REEB_OK);
  reeb_shot shot = sized<reeb_shot>();
  REQUIRE(reeb_get_shot(d, 0, &shot) == REEB_OK);
  CHECK(shot.first_frame == 0);
  CHECK(shot.frame_count == 3);
  CHECK(shot.end_frame == 6);
  REQUIRE(reeb_get_shot(d, 1, &shot) == REEB_OK);
  CHECK(shot.frame_count == 2);
  CHECK(shot.end_frame == 8);
  reeb_close(d);
}

TEST_CASE("a probe knows a file by its first eight bytes", "[c]") {
  Bytes bytes = tiny_stream();
  for (size_t n = 0; n < 8; ++n) CHECK(reeb_probe(bytes.data(), n) == REEB_NEED_MORE_DATA);
  CHECK(reeb_probe(nullptr, 0) == REEB_NEED_MORE_DATA);
  CHECK(reeb_probe(bytes.data(), 8) == REEB_OK);
  bytes[7] = 200;
  CHECK(reeb_probe(bytes.data(), 8) == REEB_UNSUPPORTED);
  bytes[3] ^= 1;
  CHECK(reeb_probe(bytes.data(), 4) == REEB_CORRUPT);
  CHECK(reeb_probe(bytes.data(), 8) == REEB_CORRUPT);
}

TEST_CASE("frames go where the target says and nowhere else", "[c]") {
  const Handle d = open_tiny();
  for (const uint32_t frame : {7u, 0u, 5u, 2u, 6u, 3u}) CHECK(gives(d.get(), frame));
  Canvas canvas;
  canvas.target.vertex_capacity = 47;
  CHECK(reeb_get_frame(d.get(), 0, &canvas.target) == REEB_INVALID_ARGUMENT);
  CHECK(canvas.shows({}));
  CHECK(reeb_get_frame(d.get(), 8, &canvas.target) == REEB_INVALID_ARGUMENT);
  char text[200];
  REQUIRE(reeb_get_message(d.get(), text, sizeof text) > 0);
  CHECK(std::string(text) == "frame 9 is past the end");
}

TEST_CASE("a file is read through a callback", "[c]") {
  FileOf file{&tiny_stream()};
  const reeb_reader reader = {tiny_stream().size(), FileOf::read_at, &file};
  reeb_options options = sized<reeb_options>();
  options.prefetch = 1;
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_reader(&reader, &options, &d) == REEB_OK);
  const Handle owner(d);
  for (int round = 0; round < 3; ++round) {
    for (uint32_t frame = 0; frame < 8; ++frame) CHECK(gives(d, frame));
  }
  CHECK_FALSE(file.overlapped);
  file.broken = true;
  reeb_decoder* none = nullptr;
  CHECK(reeb_open_reader(&reader, &options, &none) == REEB_IO);
  CHECK(none == nullptr);
}

TEST_CASE("bytes are pushed as they come", "[c]") {
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_push(nullptr, &d) == REEB_OK);
  const Handle owner(d);
  reeb_info info = sized<reeb_info>();
  CHECK(reeb_get_info(d, &info) == REEB_NEED_MORE_DATA);
  uint32_t frames = 0;
  for (const uint8_t byte : tiny_stream()) {
    REQUIRE(reeb_push(d, &byte, 1) == REEB_OK);
    if (reeb_get_info(d, &info) != REEB_OK) continue;
    for (; frames < info.frame_count; ++frames) CHECK(gives(d, frames));
  }
  CHECK(frames == 8);
  CHECK(reeb_push_end(d) == REEB_OK);
  CHECK(reeb_push_end(d) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("a time finds its place, held at the ends or around and around", "[c]") {
  const Handle d = open_tiny();
  const auto at = [&](double seconds, int loop) {
    double position = -1;
    CHECK(reeb_position_of_time(d.get(), seconds, loop, &position) == REEB_OK);
    return position;
  };
  CHECK(at(0.02, 0) == 0.5);
  CHECK(at(-1, 0) == 0);
  CHECK(at(100, 0) == 7);
  CHECK(at(0.02 + 8 / 25.0, 1) == Approx(0.5));
  CHECK(at(-0.04, 1) == 7);
  CHECK(at(0.3, 1) == 7);  // between the last frame and the first
  double position = 0;
  CHECK(reeb_position_of_time(d.get(), std::nan(""), 1, &position) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("older and newer callers have structs of other sizes", "[c]") {
  const Handle d = open_tiny();
  struct {
    reeb_info info;
    char more[16];
  } newer = {};
  std::memset(&newer, 0x55, sizeof newer);
  newer.info.struct_size = sizeof newer;
  CHECK(reeb_get_info(d.get(), &newer.info) == REEB_OK);
  CHECK(newer.info.struct_size == sizeof newer);
  CHECK(newer.more[0] == 0x55);
  reeb_info older = {};
  older.struct_size = offsetof(reeb_info, total_frames);
  CHECK(reeb_get_info(d.get(), &older) == REEB_OK);
  CHECK(older.frame_count == 8);
  CHECK(older.total_frames == 0);
  reeb_options options = {};
  reeb_decoder* none = nullptr;
  CHECK(reeb_open_push(&options, &none) == REEB_INVALID_ARGUMENT);  // struct_size forgotten
}

TEST_CASE("null pointers are invalid arguments", "[c]") {
  const Handle d = open_tiny();
  reeb_decoder* none = nullptr;
  CHECK(reeb_open_memory(nullptr, 5, nullptr, &none) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_open_memory("", 0, nullptr, nullptr) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_open_reader(nullptr, nullptr, &none) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_frame(nullptr, 0, nullptr) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_frame(d.get(), 0, nullptr) == REEB_INVALID_ARGUMENT);
  const reeb_target empty = sized<reeb_target>();
  CHECK(reeb_get_frame(d.get(), 0, &empty) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_info(d.get(), nullptr) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_triangles(d.get(), 0, nullptr, nullptr) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_polygons(d.get(), 0, nullptr, nullptr, nullptr, nullptr) == REEB_OK);
  CHECK(reeb_get_message(nullptr, nullptr, 0) == 0);
  reeb_close(nullptr);
}

TEST_CASE("limits, log and allocator of the options are used", "[c]") {
  std::vector<std::string> lines;
  reeb_options options = sized<reeb_options>();
  options.log = [](void* user, reeb_log_level level, const char* message) {
    static_cast<std::vector<std::string>*>(user)->push_back(std::to_string(level) + message);
  };
  options.log_user = &lines;
  options.limits.max_vertices = 47;
  reeb_decoder* d = nullptr;
  const Bytes& bytes = tiny_stream();
  CHECK(reeb_open_memory(bytes.data(), bytes.size(), &options, &d) == REEB_LIMIT_EXCEEDED);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "148 vertices, more than allowed");
  options.limits = {};
  CHECK(reeb_open_memory(bytes.data(), bytes.size() - 20, &options, &d) == REEB_OK);
  CHECK(lines.size() == 2);
  CHECK(lines[1] == "0the file ends early");
  reeb_close(d);

  Arena arena;
  options.allocator = arena.allocator();
  REQUIRE(reeb_open_push(&options, &d) == REEB_OK);
  REQUIRE(reeb_push(d, bytes.data(), bytes.size()) == REEB_OK);
  CHECK(arena.blocks >= 2);
  CHECK(gives(d, 3));
  reeb_close(d);
  CHECK(arena.blocks == 0);
  for (int64_t n = 0;; ++n) {
    arena.left = n;
    const bool opened = reeb_open_push(&options, &d) == REEB_OK;
    const bool pushed = opened && reeb_push(d, bytes.data(), bytes.size()) == REEB_OK;
    Canvas canvas;
    std::vector<float> normals(48 * 3);
    canvas.target.normals = normals.data();
    const reeb_result result =
        pushed ? reeb_get_between(d, 1.5, &canvas.target) : REEB_OUT_OF_MEMORY;
    if (opened) reeb_close(d);
    CHECK(arena.blocks == 0);
    if (result == REEB_OK) break;
    CHECK(result == REEB_OUT_OF_MEMORY);
    REQUIRE(n < 50);
  }
}

TEST_CASE("threads share a handle and push while others play", "[c][threads]") {
  tiny_sequence();
  reeb_options options = sized<reeb_options>();
  options.prefetch = 1;
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_push(&options, &d) == REEB_OK);
  const Handle owner(d);
  std::atomic<int> wrong{0};
  std::atomic<bool> done{false};
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 3; ++seed) {
    threads.emplace_back([&, seed] {
      std::mt19937 random(seed);
      for (int i = 0; i < 200 || !done; ++i) {
        reeb_info info = sized<reeb_info>();
        if (reeb_get_info(d, &info) != REEB_OK || info.frame_count == 0) continue;
        wrong += !gives(d, static_cast<uint32_t>(random() % info.frame_count));
      }
    });
  }
  for (const uint8_t byte : tiny_stream()) wrong += reeb_push(d, &byte, 1) != REEB_OK;
  wrong += reeb_push_end(d) != REEB_OK;
  done = true;
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("handles in parallel know nothing of each other", "[c][threads]") {
  tiny_sequence();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      reeb_options options = sized<reeb_options>();
      options.prefetch = i % 2 == 0;
      options.threads = 1 + i / 2;
      reeb_decoder* d = nullptr;
      wrong +=
          reeb_open_memory(tiny_stream().data(), tiny_stream().size(), &options, &d) != REEB_OK;
      const Handle owner(d);
      for (uint32_t round = 0; round < 5; ++round) {
        for (uint32_t frame = 0; frame < 8; ++frame)
          wrong += !gives(d, round % 2 ? frame : 7 - frame);
        reeb_cancel(d);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}
