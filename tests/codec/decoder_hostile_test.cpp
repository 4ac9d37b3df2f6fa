#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <random>

#include "bitstream/container.h"
#include "bitstream/syntax.h"
#include "tests/codec/allocation_meter.h"
#include "tests/codec/damage.h"
#include "tests/codec/hostile.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Two shots, three groups, regions, metadata.
Bytes small_stream(Profile profile, int effort = kDefaultEffort) {
  Sequence sequence = sequence_of({animate(torus(8, 6), 6), animate(mixed_polygons(), 2)});
  sequence.metadata = {{"name", "hostile"}};
  EncodeOptions options = quick_options();
  options.target_value = 3;
  options.group_length = 3;
  options.regions = 2;
  options.profile = profile;
  options.open_groups = profile == Profile::kMain ? 1 : 0;
  if (profile == Profile::kLossless) options.target = Target::kLossless;
  options.effort = effort;
  return encode_or_fail(sequence, options).bytes;
}

/// Writes the file again with changed headers; empty where the writer refuses them.
struct Changes {
  std::function<void(SequenceHeader&)> sequence = [](auto&) {};
  std::function<void(ReferenceHeader&)> reference = [](auto&) {};
  std::function<void(MeshHeader&)> mesh = [](auto&) {};
  std::function<void(GroupHeader&)> group = [](auto&) {};
};

Bytes change_mesh(std::span<const uint8_t> mesh, const Changes& changes) {
  ByteReader in(mesh);
  MeshHeader header;
  REQUIRE(read_header(in, "mesh", header).ok());
  changes.mesh(header);
  Bytes out;
  if (!write_header(header, "mesh", out).ok()) return {};
  out.insert(out.end(), mesh.begin() + static_cast<long>(in.position()), mesh.end());
  return out;
}

Bytes rewrite(const Bytes& file, const Changes& changes) {
  ContainerReader in;
  REQUIRE(in.parse(file, {}).ok());
  Bytes out;
  ContainerWriter writer(out);
  changes.sequence(in.header);
  bool fine = writer.begin(in.header).ok();
  size_t g = 0;
  for (ReferenceChunk& r : in.references) {
    const uint32_t shot = r.header.shot;
    changes.reference(r.header);
    fine = fine && writer.reference(r.header, change_mesh(r.mesh, changes)).ok();
    for (; g < in.groups.size() && in.groups[g].header.shot == shot; ++g) {
      GroupChunk& chunk = in.groups[g];
      changes.group(chunk.header);
      fine = fine && writer.group(chunk.header, chunk).ok();
    }
  }
  return fine && writer.finish().ok() ? out : Bytes{};
}

constexpr uint32_t kMany[] = {0,      1,       5,        1000,       65'535,
                              65'536, 196'608, 1u << 24, 0x7FFFFFFF, 0xFFFFFFFF};

}  // namespace

TEST_CASE("a stream cut anywhere gives its whole groups or an error", "[hostile]") {
  for (const StreamKind& kind : stream_kinds()) {
    INFO(kind.name);
    const Bytes& whole = kind.bytes;
    REQUIRE(probe(whole, tight_limits()).frames == 8);
    uint32_t most = 0;
    for (size_t size = 0; size < whole.size(); ++size) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<long>(size));
      const Outcome out = metered_probe(cut, tight_limits());
      CHECK(out.refused == 0);                        // what the stream says to be there is there
      CHECK(out.frames % 3 * (8 - out.frames) == 0);  // 0, 3, 6 or 8
      CHECK(out.frames >= most);
      most = std::max(most, out.frames);
      if (!out.opened.ok()) {
        CHECK((out.opened.code() == StatusCode::kTruncated ||
               out.opened.code() == StatusCode::kCorrupt));
      }
    }
    CHECK(most == 8);  // the seek table alone was missing
  }
}

TEST_CASE("flipped bits behind right checksums never crash", "[hostile]") {
  std::mt19937 random(1);
  uint32_t frames = 0, refused = 0, closed = 0;
  const std::vector<StreamKind> kinds = stream_kinds();
  for (int round = 0; round < 10'000; ++round) {
    const StreamKind& kind = kinds[static_cast<size_t>(round) % kinds.size()];
    INFO(kind.name << ", round " << round);
    Bytes bytes = kind.bytes;
    for (int k = 0; k < 1 + round % 3; ++k)
      bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<uint8_t>(1u << random() % 8);
    repair_checksums(bytes);
    const Outcome out = metered_probe(bytes, tight_limits());
    frames += out.frames;
    refused += out.refused;
    closed += !out.opened.ok();
  }
  // All of it was met: headers, payloads that fail and payloads that only mean something else.
  CHECK(closed > 200);
  CHECK(refused > 2000);
  CHECK(frames > 4000);
}

TEST_CASE("bytes overwritten in runs never crash", "[hostile]") {
  std::mt19937 random(2);
  const Bytes streams[] = {small_stream(Profile::kMain), small_stream(Profile::kLossless),
                           small_stream(Profile::kLossless, 1)};
  for (int round = 0; round < 900; ++round) {
    Bytes bytes = streams[round / 3 % 3];
    const size_t begin = 8 + random() % (bytes.size() - 8);
    const size_t end = std::min<size_t>(bytes.size(), begin + 1 + random() % 40);
    for (size_t i = begin; i < end; ++i)
      bytes[i] = static_cast<uint8_t>(round % 3 == 0 ? 0xFF : round % 3 == 1 ? 0 : random());
    repair_checksums(bytes);
    metered_probe(bytes, tight_limits());
  }
}

TEST_CASE("absurd counts are refused before they are believed", "[hostile]") {
  const Profile profile = GENERATE(Profile::kMain, Profile::kLossless);
  const Bytes whole = small_stream(profile);
  REQUIRE(rewrite(whole, {}).size() > 0);
  std::vector<Changes> all;
  for (const uint32_t n : kMany) {
    all.push_back({.sequence = [n](auto& h) { h.total_frames = n; }});
    all.push_back({.sequence = [n](auto& h) { h.total_frames = h.shot_count = n; }});
    all.push_back({.reference = [n](auto& h) { h.shot = n; }});
    all.push_back({.reference = [n](auto& h) { h.first_frame = n; }});
    all.push_back({.mesh = [n](auto& h) { h.vertex_count = n; }});
    all.push_back({.mesh = [n](auto& h) { h.face_count = n; }});
    all.push_back({.mesh = [n](auto& h) { h.vertex_count = h.face_count = n; }});
    all.push_back({.mesh = [n](auto& h) { h.draco_bytes = n; }});
    all.push_back({.mesh = [n](auto& h) { h.rest_bytes = n; }});
    all.push_back({.mesh = [n](auto& h) { h.order_bytes = n; }});
    all.push_back({.group = [n](auto& h) { h.first_frame = n; }});
    all.push_back({.sequence = [](auto& h) { h.total_frames = 1u << 20; },
                   .group = [n](auto& h) { h.frame_count = n; }});
    all.push_back({.group = [n](auto& h) { h.component_count = n; }});
    all.push_back({.group = [n](auto& h) { h.region_count = n; }});
    all.push_back({.sequence = [](auto& h) { h.total_frames = 1u << 20; },
                   .group =
                       [n](auto& h) {
                         h.frame_count = 65'536;
                         h.component_count = h.region_count = std::min(n, 196'608u);
                       }});
  }
  for (const float x :
       {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max(), 0.0f}) {
    all.push_back({.reference = [x](auto& h) { h.origin[0] = h.origin[2] = -x; }});
    all.push_back({.reference = [x](auto& h) { h.grid_step = x; }});
    all.push_back({.group = [x](auto& h) { h.quantization_step = x; }});
  }
  Limits generous;
  generous.max_memory = 64u << 20;
  for (size_t i = 0; i < all.size(); ++i) {
    INFO("change " << i);
    const Bytes changed = rewrite(whole, all[i]);
    if (changed.empty()) continue;
    metered_probe(changed, generous);
    metered_probe(changed, tight_limits());
  }
}

TEST_CASE("counts of corrections that are not true are refused", "[hostile]") {
  EncodeOptions options = quick_options();
  options.target = Target::kMaxError;
  options.target_value = 1e-3;
  const Bytes whole = encode_or_fail(sequence_of({animate(torus(12, 8), 6)}), options).bytes;
  uint64_t count = 0;
  REQUIRE(
      probe(rewrite(whole, {.group = [&](auto& h) { count = h.correction_count; }}), tight_limits())
          .frames == 6);
  REQUIRE(count > 1);
  for (const uint64_t other : {count - 1, count + 1, uint64_t{1} << 40}) {
    const Bytes changed = rewrite(whole, {.group = [&](auto& h) { h.correction_count = other; }});
    CHECK(metered_probe(changed, tight_limits()).refused == 6);
  }
  const auto without = [](auto& h) {
    h.flags = 0;
    h.correction_count = 0;
  };
  const Bytes changed = rewrite(whole, {.group = without});
  CHECK(metered_probe(changed, tight_limits()).frames == 0);  // bytes are left over
}

TEST_CASE("limits are respected", "[hostile]") {
  const Bytes bytes =
      encode_or_fail(sequence_of({animate(torus(16, 11), 9)}), quick_options()).bytes;
  Limits limits;
  REQUIRE(probe(bytes, limits).frames == 9);
  limits.max_vertices = 175;
  CHECK(probe(bytes, limits).opened.code() == StatusCode::kLimitExceeded);
  limits = {};
  limits.max_faces = 351;
  CHECK(probe(bytes, limits).opened.code() == StatusCode::kLimitExceeded);
  limits = {};
  limits.max_frames = 8;
  CHECK(probe(bytes, limits).opened.code() == StatusCode::kLimitExceeded);
  limits = {.max_vertices = 176, .max_faces = 352, .max_frames = 9, .max_memory = 1u << 20};
  CHECK(probe(bytes, limits).frames == 9);
  limits.max_memory = 100'000;  // a decoder alone takes more
  CHECK(probe(bytes, limits).opened.code() == StatusCode::kLimitExceeded);
  limits.max_memory = 200'000;
  CHECK(probe(bytes, limits).refused == 9);

  DecodeOptions options;
  options.limits = limits;
  Sequence sequence;
  CHECK(decode_sequence(bytes, options, sequence).code() == StatusCode::kLimitExceeded);
  CHECK(sequence.shots.empty());
}

TEST_CASE("an output beyond the limit is refused before it is allocated", "[hostile]") {
  // A mesh at rest: few bytes, many frames.
  const Sequence original = sequence_of({animate(torus(16, 11), 800, rest)});
  EncodeOptions encode_options = quick_options();
  encode_options.group_length = 50;
  const Bytes bytes = encode_or_fail(original, encode_options).bytes;
  DecodeOptions options;
  options.limits.max_memory = 1'200'000;  // the positions take 1.7 MB, a group 0.9 MB
  Sequence sequence;
  const AllocationMeter meter;
  CHECK(decode_sequence(bytes, options, sequence).code() == StatusCode::kLimitExceeded);
  CHECK(meter.peak() <= options.limits.max_memory);
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, options, decoder).ok());
  std::vector<float> xyz(176 * 3);
  CHECK(decoder->decode_frame(799, xyz.data()).ok());  // frame by frame it is no matter
}

TEST_CASE("many shots do not pile up in memory", "[hostile]") {
  std::vector<Shot> shots;
  for (uint32_t i = 0; i < 40; ++i) shots.push_back(animate(torus(20, 10), 1));
  const Bytes bytes = encode_or_fail(sequence_of(shots), quick_options()).bytes;
  Limits limits;
  limits.max_memory = 2u << 20;
  CHECK(metered_probe(bytes, limits).frames == 20);
  // Back and forth between shots, whose surfaces are made anew.
  const Sequence whole = decode_or_fail(bytes);
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  std::vector<float> xyz(600);
  for (const uint32_t frame : {5u, 30u, 5u, 6u, 39u, 0u}) {
    const Connectivity* other = nullptr;
    REQUIRE(decoder->decode_frame(frame, xyz.data()).ok());
    CHECK(std::equal(xyz.begin(), xyz.end(), whole.shots[frame].positions.begin()));
    REQUIRE(decoder->connectivity((frame + 7) % 40, other).ok());
    REQUIRE(decoder->decode_frame(frame, xyz.data()).ok());
    CHECK(std::equal(xyz.begin(), xyz.end(), whole.shots[frame].positions.begin()));
    CHECK(face_set(*other) == face_set(shots[0].connectivity));
  }
}

TEST_CASE("bytes that are no stream are refused", "[hostile]") {
  std::mt19937 random(3);
  for (size_t size = 0; size < 300; ++size) {
    Bytes bytes(size);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(random());
    CHECK_FALSE(probe(bytes, {}).opened.ok());
  }
}
