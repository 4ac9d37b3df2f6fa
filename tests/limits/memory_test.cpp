// The decoder's account of its memory against the heap, for every kind of stream: neither is the
// heap larger than the account, nor does a limit of what the account came to refuse the stream.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/codec/allocation_meter.h"
#include "tests/codec/attributes/samples.h"
#include "tests/limits/built_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

constexpr double kTolerance = 1.02;

/// What a call gives is the caller's, and there before anything is measured.
struct Room {
  std::vector<float> xyz, normals;
  Attribute attribute;
};

/// A player that uses all that a stream has, at up to eight moments.
Status play(Decoder& decoder, Room& room) {
  const uint32_t count = decoder.info().frame_count;
  for (uint32_t i = 0; i < std::min(count, 8u); ++i) {
    const uint32_t frame = i * std::max(1u, count / 8);
    std::span<const uint32_t> triangles;
    if (Status s = decoder.triangles(frame, triangles); !s.ok()) return s;
    const FrameTarget target = {.positions = room.xyz.data(), .normals = room.normals.data()};
    if (Status s = decoder.decode_frame(frame, target); !s.ok()) return s;
    for (uint32_t a = 0; a < decoder.info().attributes.size(); ++a) {
      if (Status s = decoder.decode_attribute(frame, a, room.attribute); !s.ok()) return s;
    }
  }
  return {};
}

struct Measured {
  Status status;
  uint64_t heap = 0, account = 0;
};

enum class How { kWhole, kPushed, kAhead };

Status open(const Bytes& file, const DecodeOptions& options, How how,
            std::unique_ptr<Decoder>& decoder) {
  if (how != How::kPushed) return Decoder::open(file, options, decoder);
  if (Status s = Decoder::open_pushed(options, decoder); !s.ok()) return s;
  constexpr size_t kPiece = 100'000;
  for (size_t at = 0; at < file.size(); at += kPiece) {
    const std::span<const uint8_t> piece =
        std::span(file).subspan(at, std::min(kPiece, file.size() - at));
    if (Status s = decoder->push(piece); !s.ok()) return s;
  }
  return decoder->finish();
}

Measured measure(const Bytes& file, uint64_t limit, How how, Room& room) {
  Measured out;
  DecodeOptions options;
  options.limits.max_memory = limit;
  if (how == How::kAhead) {
    options.threads = 2;
    options.prefetch = true;
  }
  room.attribute = {};
  const AllocationMeter meter;
  std::unique_ptr<Decoder> decoder;
  out.status = open(file, options, how, decoder);
  if (out.status.ok()) out.status = play(*decoder, room);
  out.heap = meter.peak();
  if (decoder != nullptr) out.account = decoder->stats().peak_memory;
  return out;
}

void check_memory(const char* name, const Bytes& file) {
  Room room;
  {
    std::unique_ptr<Decoder> decoder;
    REQUIRE(Decoder::open(file, {}, decoder).ok());
    uint32_t most = 0;
    for (const StreamInfo::ShotInfo& shot : decoder->info().shots)
      most = std::max(most, shot.vertex_count);
    room.xyz.resize(size_t{3} * most);
    room.normals.resize(size_t{3} * most);
  }
  for (const How how : {How::kWhole, How::kPushed, How::kAhead}) {
    if (kSlowness > 1 && how != How::kWhole) continue;
    const Measured free = measure(file, Limits().max_memory, how, room);
    INFO(name << ", " << file.size() << " bytes, way " << static_cast<int>(how) << ": heap "
              << free.heap << ", account " << free.account);
    CHECK(free.status.ok());
    CHECK(free.account > 2'000'000);  // what is not counted, of a fixed size, is no matter then
    CHECK(static_cast<double>(free.heap) <= kTolerance * static_cast<double>(free.account));
    for (const double share : {1.0, 0.7, 0.3, 0.1}) {
      if (kSlowness > 1 && share < 1) continue;
      const auto limit = static_cast<uint64_t>(share * static_cast<double>(free.account));
      const Measured tight = measure(file, limit, how, room);
      INFO("limit " << limit << ": heap " << tight.heap);
      CHECK((tight.status.ok() || tight.status.code() == StatusCode::kLimitExceeded));
      if (share == 1) CHECK(tight.status.ok());
      CHECK(static_cast<double>(tight.heap) <= kTolerance * static_cast<double>(limit));
    }
  }
}

/// The file, with something in front of its last chunk that a writer does not put there.
Bytes insert_before_seek(const Bytes& file, const Bytes& more) {
  const std::string mark = "seek";
  const auto at = std::find_end(file.begin(), file.end(), mark.begin(), mark.end());
  Bytes out(file.begin(), at);
  out.insert(out.end(), more.begin(), more.end());
  out.insert(out.end(), at, file.end());
  return out;
}

Bytes many_groups(uint32_t count) {
  const CodedMesh mesh = code_mesh(single_vertex(), false, 4);
  const Bytes basis = zero_basis(1, 0);
  Bytes out;
  ContainerWriter writer(out);
  REQUIRE(writer.begin({.total_frames = count}).ok());
  REQUIRE(writer.reference({}, mesh.bytes).ok());
  for (uint32_t g = 0; g < count; ++g) {
    GroupHeader h;
    h.first_frame = g;
    REQUIRE(writer.group(h, {.basis = basis}).ok());
  }
  REQUIRE(writer.finish().ok());
  return out;
}

Bytes with_metadata(size_t entries, size_t key, size_t value) {
  const CodedMesh mesh = code_mesh(single_vertex(), false, 4);
  const Bytes basis = zero_basis(1, 0);
  std::vector<MetadataEntry> all(entries);
  for (size_t i = 0; i < entries; ++i) {
    all[i].key = std::to_string(i);
    all[i].key.resize(std::max(key, all[i].key.size()), 'k');
    all[i].value = std::string(value, 'v');
  }
  Bytes out;
  ContainerWriter writer(out);
  REQUIRE(writer.begin({.total_frames = 1}).ok());
  REQUIRE(writer.metadata(all).ok());
  REQUIRE(writer.reference({}, mesh.bytes).ok());
  REQUIRE(writer.group({}, {.basis = basis}).ok());
  REQUIRE(writer.finish().ok());
  return out;
}

Bytes encoded(const Shape& shape, uint32_t frames, Profile profile, uint32_t open_groups = 0) {
  EncodeOptions options = quick_options();
  options.profile = profile;
  options.effort = kMinEffort;
  options.group_length = open_groups > 0 ? 4 : frames;
  options.open_groups = open_groups;
  return encode_or_fail(sequence_of({animate(shape, frames)}), options).bytes;
}

Bytes lossless(const Shape& shape, uint32_t count, bool quick) {
  std::vector<std::vector<float>> frames;
  for (uint32_t t = 0; t < count; ++t) {
    frames.push_back(shape.positions);
    for (size_t i = 0; i < frames[t].size(); ++i)
      frames[t][i] += static_cast<float>(t * (i % 5)) / 64;
  }
  return lossless_file(shape, frames, quick);
}

}  // namespace

TEST_CASE("the heap is no larger than the account: meshes", "[memory]") {
  for (const Shape& shape : {torus(120, 60), grid(100, 80), points_only(20'000), strip(10'000),
                             hub(8000), fins(3000), doubled_strip(6000)}) {
    for (const bool plain : {false, true}) {
      const CodedMesh mesh = code_mesh(shape, plain, 10);
      check_memory((shape.name + (plain ? ", plain" : "")).c_str(),
                   zero_file(mesh, plain ? Profile::kFast : Profile::kMain, 2, 1));
    }
  }
}

TEST_CASE("the heap is no larger than the account: components", "[memory]") {
  const CodedMesh few = code_mesh(torus(40, 25), false, 10);
  const CodedMesh point = code_mesh(single_vertex(), false, 4);
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    const std::string name = profile == Profile::kMain ? "main" : "fast";
    check_memory((name + ", many components").c_str(), zero_file(few, profile, 400, 1000));
    check_memory((name + ", many frames").c_str(), zero_file(point, profile, 3000, 60));
  }
  check_memory("thesis", encoded(torus(60, 40), 20, Profile::kThesis));
}

TEST_CASE("the heap is no larger than the account: values", "[memory]") {
  // The first components are wide.
  Sequence sequence = sequence_of({animate(torus(60, 40), 24)});
  std::mt19937 random(1);
  for (float& x : sequence.shots[0].positions)
    x += static_cast<float>(std::normal_distribution(0.0, 1.0)(random));
  EncodeOptions options = quick_options();
  options.effort = kMinEffort;
  options.target_value = 0.01;
  options.group_length = 24;
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    options.profile = profile;
    check_memory(profile == Profile::kMain ? "main, wide" : "fast, wide",
                 encode_or_fail(sequence, options).bytes);
  }
}

TEST_CASE("the heap is no larger than the account: corrections and open groups", "[memory]") {
  check_memory("corrections", corrected_file(code_mesh(torus(60, 40), false, 10), 20));
  check_memory("open groups", encoded(torus(60, 40), 32, Profile::kMain, 7));
}

TEST_CASE("the heap is no larger than the account: lossless", "[memory]") {
  for (const bool quick : {false, true})
    check_memory(quick ? "lossless, quick" : "lossless", lossless(torus(60, 40), 20, quick));
}

TEST_CASE("the heap is no larger than the account: headers", "[memory]") {
  check_memory("groups", many_groups(20'000));
  check_memory("small entries", with_metadata(60'000, 1, 0));
  check_memory("entries", with_metadata(40'000, 16, 31));
  check_memory("a large entry", with_metadata(1, 4, 4'000'000));
  // Chunks whose checksums are wrong.
  Bytes damage;
  for (int i = 0; i < 40'000; ++i) {
    for (const char c : std::string("xxxx")) damage.push_back(static_cast<uint8_t>(c));
    for (int k = 0; k < 6; ++k) damage.push_back(k == 0 ? 1 : 0);
  }
  check_memory("damage", insert_before_seek(many_groups(10), damage));
}

TEST_CASE("the heap is no larger than the account: attributes", "[memory]") {
  const Shape shape = torus(60, 40);
  Sequence sequence = sequence_of({animate(shape, 2)});
  std::vector<float> corners, vertices;
  for (size_t c = 0; c < shape.connectivity.corners.size(); ++c) {
    corners.push_back(static_cast<float>(shape.connectivity.corners[c] % 97) / 97);
    corners.push_back(static_cast<float>(c % 5 / 4) / 8);
  }
  for (uint32_t t = 0; t < 2; ++t) {
    for (uint32_t v = 0; v < shape.connectivity.vertex_count; ++v)
      vertices.push_back(static_cast<float>((v * 31 + t * 7) % 64));
  }
  Shot& shot = sequence.shots[0];
  shot.attributes.push_back(make("uv", Domain::kCorner, ValueType::kBinary32, 2, corners));
  Attribute heat = make("heat", Domain::kVertex, ValueType::kBinary32, 1, vertices);
  heat.animated = true;
  shot.attributes.push_back(heat);
  add_turned_normals(shot);
  EncodeOptions options = quick_options();
  options.target = Target::kLossless;
  options.effort = kMinEffort;
  check_memory("attributes", encode_or_fail(sequence, options).bytes);
}
