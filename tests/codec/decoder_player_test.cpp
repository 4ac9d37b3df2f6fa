// The decoder as a player uses it: sources, seeking, the group decoded ahead, damage, memory.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include "bitstream/container.h"
#include "tests/codec/allocation_meter.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Counts what is read, and can fail.
class CountingSource : public ByteSource {
 public:
  struct Log {
    uint64_t bytes = 0;
    uint64_t fail_after = UINT64_MAX;  ///< bytes
  };
  CountingSource(Bytes bytes, Log& log) : bytes_(std::move(bytes)), log_(log) {}
  uint64_t size() const override { return bytes_.size(); }
  Status read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
              std::span<const uint8_t>& out) override {
    REQUIRE(offset + count <= bytes_.size());
    log_.bytes += count;
    if (log_.bytes > log_.fail_after) return Status::io("the disk is gone");
    const auto from = bytes_.begin() + static_cast<long>(offset);
    buffer.assign(from, from + static_cast<long>(count));
    out = buffer;
    return {};
  }

 private:
  Bytes bytes_;
  Log& log_;
};

/// Two shots of 23 and 9 frames in groups of up to 5 frames.
const Bytes& stream() {
  static const Bytes bytes = [] {
    EncodeOptions options = quick_options();
    options.group_length = 5;
    Sequence sequence = sequence_of({animate(torus(16, 11), 23), animate(grid(9, 8), 9)});
    sequence.frame_rate = 25;
    return encode_or_fail(sequence, options).bytes;
  }();
  return bytes;
}

const Sequence& decoded() {
  static const Sequence sequence = decode_or_fail(stream());
  return sequence;
}

std::span<const float> expected(uint32_t frame) {
  return frame < 23 ? decoded().shots[0].frame(frame) : decoded().shots[1].frame(frame - 23);
}

bool gives(Decoder& decoder, uint32_t frame) {
  const auto wanted = expected(frame);
  std::vector<float> xyz(wanted.size());
  return decoder.decode_frame(frame, xyz.data()).ok() &&
         std::memcmp(xyz.data(), wanted.data(), wanted.size_bytes()) == 0;
}

std::unique_ptr<Decoder> open_memory(const Bytes& bytes, const DecodeOptions& options = {}) {
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, options, decoder).ok());
  return decoder;
}

std::unique_ptr<Decoder> open_source(const Bytes& bytes, CountingSource::Log& log,
                                     const DecodeOptions& options = {}) {
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(std::make_unique<CountingSource>(bytes, log), options, decoder).ok());
  return decoder;
}

ContainerReader chunks_of(const Bytes& bytes) {
  ContainerReader reader;
  REQUIRE(reader.parse(bytes, {}).ok());
  return reader;
}

/// Waits, not for long, until the group decoded ahead is there.
void wait_for_ahead(const Decoder& decoder, uint64_t groups) {
  for (int i = 0; i < 5000 && decoder.stats().groups_ahead < groups; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  REQUIRE(decoder.stats().groups_ahead == groups);
}

}  // namespace

TEST_CASE("a source is read where it is needed, and gives the same", "[player]") {
  CountingSource::Log log;
  const auto decoder = open_source(stream(), log);
  const ContainerReader chunks = chunks_of(stream());
  const StreamInfo& info = decoder->info();
  CHECK(info.groups.size() == 7);
  CHECK(info.frame_count == 32);
  CHECK(info.missing.empty());
  CHECK(log.bytes < 7 * 600 + 2 * 600 + 2000);  // fronts of chunks and the seek table
  log.bytes = 0;
  REQUIRE(gives(*decoder, 12));
  CHECK(log.bytes == chunks.references[0].size + chunks.groups[2].size);
  log.bytes = 0;
  for (const uint32_t frame : {10u, 11u, 14u, 13u}) REQUIRE(gives(*decoder, frame));
  CHECK(log.bytes == 0);
  for (uint32_t frame = 0; frame < 32; ++frame) REQUIRE(gives(*decoder, frame));
}

TEST_CASE("a source that fails is reported, and may recover", "[player]") {
  CountingSource::Log log;
  const auto decoder = open_source(stream(), log);
  log.fail_after = log.bytes;
  float xyz[528];
  CHECK(decoder->decode_frame(3, xyz).code() == StatusCode::kIo);
  log.fail_after = UINT64_MAX;
  CHECK(gives(*decoder, 3));
  for (uint64_t bytes = 0; bytes < 3000; bytes += 7) {
    CountingSource::Log failing{0, bytes};
    std::unique_ptr<Decoder> none;
    const Status status =
        Decoder::open(std::make_unique<CountingSource>(stream(), failing), {}, none);
    CHECK((status.ok() || status.code() == StatusCode::kIo));
  }
}

TEST_CASE("a damaged group is reported and the others decode", "[player]") {
  const ContainerReader chunks = chunks_of(stream());
  for (const size_t hit : {size_t{0}, size_t{2}, size_t{6}}) {
    Bytes bytes = stream();
    bytes[chunks.groups[hit].offset + chunks.groups[hit].size - 10] ^= 4;
    CountingSource::Log log;
    for (const auto& decoder : {open_memory(bytes).release(), open_source(bytes, log).release()}) {
      const std::unique_ptr<Decoder> owner(decoder);
      for (uint32_t frame = 0; frame < 32; ++frame) {
        const GroupHeader& h = chunks.groups[hit].header;
        const bool lost = frame >= h.first_frame && frame < h.first_frame + h.frame_count;
        std::vector<float> xyz(expected(frame).size());
        if (lost) {
          const Status status = decoder->decode_frame(frame, xyz.data());
          const bool beyond = frame >= decoder->info().frame_count;
          CHECK(status.code() == StatusCode::kCorrupt);
          CHECK((beyond || status.message().find("damaged") != std::string::npos));
        } else {
          CHECK(gives(*decoder, frame));
        }
      }
    }
    const auto decoder = open_memory(bytes);
    REQUIRE(decoder->info().missing.size() == 1);
    CHECK(decoder->info().missing[0].first_frame == chunks.groups[hit].header.first_frame);
    CHECK(decoder->info().missing[0].frame_count == chunks.groups[hit].header.frame_count);
    Sequence rest;
    CHECK(decode_sequence(bytes, {}, rest).code() == StatusCode::kCorrupt);
    CHECK(rest.frame_count() == 32 - chunks.groups[hit].header.frame_count);
  }
}

TEST_CASE("damage behind a right checksum costs one group of a sequence", "[player]") {
  // The second group is made anew around an empty basis.
  Bytes out;
  ContainerWriter writer(out);
  const ContainerReader chunks = chunks_of(stream());
  REQUIRE(writer.begin(chunks.header).ok());
  size_t g = 0;
  for (const ReferenceChunk& r : chunks.references) {
    REQUIRE(writer.reference(r.header, r.mesh).ok());
    for (; g < chunks.groups.size() && chunks.groups[g].header.shot == r.header.shot; ++g) {
      GroupChunk chunk = chunks.groups[g];
      if (g == 1) chunk.basis = {};
      REQUIRE(writer.group(chunk.header, chunk).ok());
    }
  }
  REQUIRE(writer.finish().ok());
  Sequence rest;
  DecodeOptions options;
  options.threads = 2;
  CHECK(decode_sequence(out, options, rest).code() == StatusCode::kCorrupt);
  REQUIRE(rest.shots.size() == 2);
  CHECK(rest.shots[0].frame_count == 23 - chunks.groups[1].header.frame_count);
  const auto tail = rest.shots[0].frame(rest.shots[0].frame_count - 1);
  CHECK(std::equal(tail.begin(), tail.end(), expected(22).begin()));
}

TEST_CASE("a truncated sequence gives what is there and says so", "[player]") {
  const GroupChunk cut = chunks_of(stream()).groups[3];
  const Bytes bytes(stream().begin(), stream().begin() + static_cast<long>(cut.offset + 9));
  Sequence rest;
  CHECK(decode_sequence(bytes, {}, rest).code() == StatusCode::kTruncated);
  CHECK(rest.frame_count() == cut.header.first_frame);
  const auto decoder = open_memory(bytes);
  CHECK(decoder->info().truncated);
  CHECK(decoder->info().frame_count == cut.header.first_frame);
  CHECK(decoder->info().total_frames == 32);
  for (uint32_t frame = 0; frame < cut.header.first_frame; ++frame) CHECK(gives(*decoder, frame));
}

TEST_CASE("pushed bytes give frames as soon as their group is whole", "[player]") {
  const ContainerReader chunks = chunks_of(stream());
  for (const size_t step : {size_t{1}, size_t{7}, size_t{1000}, stream().size()}) {
    std::unique_ptr<Decoder> decoder;
    REQUIRE(Decoder::open_pushed({}, decoder).ok());
    float nothing[1];
    CHECK(decoder->decode_frame(0, nothing).code() == StatusCode::kNeedMoreData);
    uint32_t known = 0;
    for (size_t at = 0; at < stream().size(); at += step) {
      const size_t count = std::min(step, stream().size() - at);
      REQUIRE(decoder->push(std::span(stream()).subspan(at, count)).ok());
      uint32_t whole = 0;
      for (const GroupChunk& g : chunks.groups) {
        if (g.offset + g.size <= at + count) whole = g.header.first_frame + g.header.frame_count;
      }
      REQUIRE(decoder->info().frame_count == whole);
      for (; known < whole; ++known) REQUIRE(gives(*decoder, known));
      if (known < 32) {
        std::vector<float> xyz(528);
        CHECK(decoder->decode_frame(known, xyz.data()).code() == StatusCode::kNeedMoreData);
      }
    }
    REQUIRE(decoder->finish().ok());
    CHECK_FALSE(decoder->info().truncated);
    CHECK(decoder->info().missing.empty());
    CHECK(decoder->push(stream()).code() == StatusCode::kInvalidArgument);
    CHECK(known == 32);
  }
}

TEST_CASE("pushed bytes that are damaged or end early", "[player]") {
  const ContainerReader chunks = chunks_of(stream());
  Bytes bytes = stream();
  bytes[chunks.groups[1].offset + 5] ^= 0x40;  // its length
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open_pushed({}, decoder).ok());
  REQUIRE(decoder->push(bytes).ok());
  REQUIRE(decoder->finish().ok());
  for (uint32_t frame = 0; frame < 32; ++frame) {
    if (frame < 5 || frame > 9) CHECK(gives(*decoder, frame));
  }
  REQUIRE(decoder->info().missing.size() == 1);
  CHECK(decoder->info().groups.size() == 6);

  REQUIRE(Decoder::open_pushed({}, decoder).ok());
  REQUIRE(decoder->push(std::span(stream()).first(stream().size() / 2)).ok());
  REQUIRE(decoder->finish().ok());
  CHECK(decoder->info().truncated);
  std::vector<float> xyz(528);
  CHECK(decoder->decode_frame(31, xyz.data()).code() == StatusCode::kCorrupt);
  CHECK(gives(*decoder, 0));

  REQUIRE(Decoder::open_pushed({}, decoder).ok());
  CHECK(decoder->push(Bytes(20, 'x')).code() == StatusCode::kCorrupt);
  DecodeOptions small;
  small.limits.max_memory = 150'000;
  REQUIRE(Decoder::open_pushed(small, decoder).ok());
  CHECK(decoder->push(stream()).code() == StatusCode::kLimitExceeded);
}

TEST_CASE("playing decodes each group once, the next one ahead", "[player]") {
  DecodeOptions options;
  options.prefetch = true;
  const auto decoder = open_memory(stream(), options);
  for (uint32_t frame = 0; frame < 32; ++frame) {
    REQUIRE(gives(*decoder, frame));
    // The second frame of each group starts the next one.
    const auto& groups = chunks_of(stream()).groups;
    for (size_t g = 0; g + 1 < groups.size(); ++g) {
      if (frame == groups[g].header.first_frame + 1) wait_for_ahead(*decoder, g + 1);
    }
  }
  const DecodeStats stats = decoder->stats();
  CHECK(stats.frames == 32);
  CHECK(stats.groups_decoded == 7);
  CHECK(stats.groups_ahead == 6);
  CHECK(stats.longest_stall > 0);
  CHECK(stats.longest_stall_frame < 32);
  decoder->reset_stats();
  CHECK(decoder->stats().frames == 0);
  CHECK(decoder->stats().groups_decoded == 0);
}

TEST_CASE("playing backwards and around decodes ahead, too", "[player]") {
  DecodeOptions options;
  options.prefetch = true;
  options.cache_bytes = 0;  // nothing but the group in use and the next
  const auto decoder = open_memory(stream(), options);
  decoder->set_loop(true);
  const std::vector<StreamInfo::Group>& groups = decoder->info().groups;
  uint64_t ahead = 0;
  for (uint32_t i = 0; i < 3 * 32; ++i) {
    const uint32_t frame = 31 - i % 32;
    REQUIRE(gives(*decoder, frame));
    // The second frame met of each group starts the next one.
    for (const StreamInfo::Group& g : groups) {
      if (frame + 2 == g.first_frame + g.frame_count) wait_for_ahead(*decoder, ++ahead);
    }
  }
  CHECK(ahead == 3 * groups.size());
  CHECK(decoder->stats().groups_decoded == 1 + ahead);
}

TEST_CASE("jumping about decodes at most one group a frame", "[player]") {
  DecodeOptions options;
  options.cache_bytes = 0;
  const auto decoder = open_memory(stream(), options);
  std::mt19937 random(5);
  for (uint64_t i = 1; i <= 60; ++i) {
    REQUIRE(gives(*decoder, static_cast<uint32_t>(random() % 32)));
    CHECK(decoder->stats().groups_decoded <= i);
  }
  // A cache that holds them all decodes each once.
  const auto roomy = open_memory(stream());
  for (int i = 0; i < 200; ++i) REQUIRE(gives(*roomy, static_cast<uint32_t>(random() % 32)));
  CHECK(roomy->stats().groups_decoded == 7);
}

TEST_CASE("memory stays within the limit while a group is decoded ahead", "[player]") {
  uint64_t needed = 0;
  {
    const auto decoder = open_memory(stream());
    for (uint32_t frame = 0; frame < 32; ++frame) REQUIRE(gives(*decoder, frame));
    needed = decoder->stats().peak_memory;
  }
  for (const double share : {1.0, 1.1, 1.5, 2.0}) {
    DecodeOptions options;
    options.prefetch = true;
    options.limits.max_memory = static_cast<uint64_t>(static_cast<double>(needed) * share);
    const auto decoder = open_memory(stream(), options);
    std::mt19937 random(6);
    for (uint32_t i = 0; i < 150; ++i) {
      const uint32_t frame = i < 64 ? i % 32 : static_cast<uint32_t>(random() % 32);
      REQUIRE(gives(*decoder, frame));
    }
    CHECK(decoder->stats().peak_memory <= options.limits.max_memory);
  }
}

TEST_CASE("memory is accounted for that decoding takes, and not much more", "[player]") {
  constexpr size_t kModels = 1u << 20;  // of any size of mesh
  for (const Profile profile : {Profile::kMain, Profile::kFast, Profile::kLossless}) {
    for (const Shape& shape : {torus(150, 60), points_only(9000), strip(9000)}) {
      EncodeOptions options = quick_options();
      options.profile = profile;
      if (profile == Profile::kLossless) options.target = Target::kLossless;
      options.effort = kMinEffort;
      const Bytes bytes = encode_or_fail(sequence_of({animate(shape, 3)}), options).bytes;
      INFO(shape.name << ", profile " << static_cast<int>(profile));
      std::vector<float> xyz(shape.positions.size());
      const AllocationMeter meter;
      std::unique_ptr<Decoder> decoder;
      REQUIRE(Decoder::open(bytes, {}, decoder).ok());
      REQUIRE(decoder->decode_frame(0, xyz.data()).ok());
      CHECK(meter.peak() <= decoder->stats().peak_memory + kModels);
      if (meter.peak() > 0) CHECK(decoder->stats().peak_memory <= 2 * meter.peak() + kModels);
    }
  }
}

TEST_CASE("a time between frames is on the line between them", "[player]") {
  const auto decoder = open_memory(stream());
  std::vector<float> xyz(528);
  for (const double time : {0.0, 4.25, 7.5, 12.0, 21.999}) {
    REQUIRE(decoder->decode_at(time, {.positions = xyz.data()}).ok());
    const auto first = static_cast<uint32_t>(time);
    const auto a = expected(first), b = expected(first + 1);
    for (size_t i = 0; i < a.size(); ++i) {
      const double line = double{a[i]} + (double{b[i]} - double{a[i]}) * (time - first);
      REQUIRE(double{xyz[i]} == Approx(line).margin(1e-5));
    }
  }
  REQUIRE(decoder->decode_at(22.7, {.positions = xyz.data()}).ok());  // the next is another mesh
  CHECK(std::equal(expected(22).begin(), expected(22).end(), xyz.begin()));
  REQUIRE(decoder->decode_at(31, {.positions = xyz.data()}).ok());
  for (const double time : {-0.1, 31.001, 1e300, std::nan("")})
    CHECK(decoder->decode_at(time, {.positions = xyz.data()}).code() ==
          StatusCode::kInvalidArgument);
}

TEST_CASE("normals are of unit length and stand on the surface", "[player]") {
  const Sequence flat = sequence_of({animate(grid(9, 8), 1, rest)});
  const Bytes bytes = encode_or_fail(flat, quick_options()).bytes;
  const auto decoder = open_memory(stream());
  std::vector<float> xyz(23 * 528), normals(176 * 4, 7.0f);
  REQUIRE(decoder
              ->decode_frame(
                  4, {.positions = xyz.data(), .normals = normals.data(), .normal_stride = 4})
              .ok());
  std::span<const uint32_t> triangles;
  REQUIRE(decoder->triangles(4, triangles).ok());
  REQUIRE(triangles.size() == 3 * 2 * 176);
  std::vector<double> sums(176 * 3, 0);
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const float* p[3];
    for (size_t i = 0; i < 3; ++i) p[i] = &xyz[triangles[t + i] * 3];
    for (size_t a = 0; a < 3; ++a) {
      const size_t b = (a + 1) % 3, c = (a + 2) % 3;
      const auto edge = [&](size_t i, size_t axis) {
        return double{p[i][axis]} - double{p[0][axis]};
      };
      for (size_t i = 0; i < 3; ++i)
        sums[triangles[t + i] * 3 + a] += edge(1, b) * edge(2, c) - edge(1, c) * edge(2, b);
    }
  }
  for (size_t v = 0; v < 176; ++v) {
    const double* s = &sums[v * 3];
    const double length = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    for (size_t a = 0; a < 3; ++a)
      CHECK(double{normals[v * 4 + a]} == Approx(s[a] / length).margin(1e-6));
    CHECK(normals[v * 4 + 3] == 7.0f);
  }
  const Bytes points =
      encode_or_fail(sequence_of({animate(points_only(5), 1)}), quick_options()).bytes;
  const auto cloud = open_memory(points);
  std::fill(normals.begin(), normals.end(), 7.0f);
  REQUIRE(cloud->decode_frame(0, {.positions = xyz.data(), .normals = normals.data()}).ok());
  CHECK(std::all_of(normals.begin(), normals.begin() + 15, [](float x) { return x == 0; }));
  CHECK(normals[15] == 7.0f);
}

TEST_CASE("threads share a decoder", "[player]") {
  DecodeOptions options;
  options.prefetch = true;
  options.threads = 2;
  const auto decoder = open_memory(stream(), options);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 4; ++seed) {
    threads.emplace_back([&, seed] {
      std::mt19937 random(seed);
      for (int i = 0; i < 60; ++i) wrong += !gives(*decoder, static_cast<uint32_t>(random() % 32));
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("several decoders run in parallel", "[player]") {
  decoded();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      DecodeOptions options;
      options.prefetch = true;
      std::unique_ptr<Decoder> decoder;
      if (!Decoder::open(stream(), options, decoder).ok()) ++wrong;
      for (uint32_t frame = 0; decoder && frame < 32; ++frame) wrong += !gives(*decoder, frame);
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("a call can be cancelled from another thread", "[player]") {
  const Bytes bytes = encode_or_fail(large_sequence(), quick_options()).bytes;
  const auto decoder = open_memory(bytes);
  std::vector<float> xyz(size_t{decoder->info().shots[0].vertex_count} * 3);
  std::atomic<bool> done{false};
  Status status;
  std::thread player([&] {
    status = decoder->decode_frame(0, xyz.data());
    done = true;
  });
  while (!done) {
    decoder->cancel();
    std::this_thread::yield();
  }
  player.join();
  CHECK((status.ok() || status.code() == StatusCode::kCancelled));
  CHECK(decoder->decode_frame(0, xyz.data()).ok());
}
