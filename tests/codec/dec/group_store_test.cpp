#include "codec/dec/group_store.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "codec/dec/group_memory.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

constexpr uint32_t kGroupFrames = 5;

/// 30 frames in groups of 5; `open`: as many as may continue the one before.
Bytes stream(uint32_t open) {
  EncodeOptions options = quick_options();
  options.group_length = kGroupFrames;
  options.open_groups = open;
  return encode_or_fail(sequence_of({animate(torus(18, 11), 30)}), options).bytes;
}

/// A store over a file in memory, and requests of its groups.
struct Opened {
  Bytes bytes;
  MemorySource source;
  ContainerReader container;
  MemoryAccount account;
  GroupStore store;

  explicit Opened(Bytes file, const DecodeOptions& options = {})
      : bytes(std::move(file)),
        source(bytes),
        account(options.limits.max_memory),
        store(source, options, account) {
    REQUIRE(container.parse(bytes, Limits{}).ok());
  }
  GroupRequest request(size_t group) const {
    GroupRequest out;
    size_t first = group;
    while (container.groups[first].continues()) --first;
    out.run.assign(container.groups.begin() + static_cast<long>(first),
                   container.groups.begin() + static_cast<long>(group) + 1);
    out.reference = container.references[0];
    out.continued = group + 1 < container.groups.size() && container.groups[group + 1].continues();
    return out;
  }
  std::shared_ptr<const OpenGroup> get(size_t group) {
    std::shared_ptr<const OpenGroup> out;
    REQUIRE(store.get(request(group), {}, out).ok());
    return out;
  }
};

/// A limit that the peak of decoding one group does not leave room for another beside.
uint64_t memory_of_one(const Opened& o) {
  const uint64_t vertices = o.container.references[0].mesh_header.vertex_count;
  return group_memory(vertices, o.container.groups[0].header, false);
}

}  // namespace

TEST_CASE("a group that is kept is given again, not decoded again", "[group_store]") {
  Opened o(stream(0));
  const auto first = o.get(0);
  CHECK(first->header.first_frame == 0);
  CHECK(first->synthesis.frame_count() == kGroupFrames);
  CHECK(o.get(0) == first);
  CHECK(o.store.decoded_count() == 1);
  CHECK(o.get(3)->header.first_frame == 3 * kGroupFrames);
  CHECK(o.get(0) == first);
  CHECK(o.store.decoded_count() == 2);
}

TEST_CASE("frames are those of the whole decoder", "[group_store]") {
  Opened o(stream(2));
  const Sequence whole = decode_or_fail(o.bytes);
  for (const size_t g : {4u, 1u, 5u, 0u}) {
    const auto group = o.get(g);
    for (uint32_t t = 0; t < kGroupFrames; ++t) {
      const auto wanted = whole.shots[0].frame(group->header.first_frame + t);
      std::vector<float> xyz(wanted.size());
      group->synthesis.frame(t, xyz.data(), 3);
      CHECK(std::memcmp(xyz.data(), wanted.data(), wanted.size_bytes()) == 0);
    }
  }
}

TEST_CASE("a run is decoded from its start once, then gone on from", "[group_store]") {
  Opened o(stream(2));  // 0 1 2, 3 4 5
  REQUIRE(o.container.groups[2].continues());
  REQUIRE_FALSE(o.container.groups[3].continues());
  o.get(1);
  CHECK(o.store.decoded_count() == 2);  // 0 and 1
  o.get(2);
  CHECK(o.store.decoded_count() == 3);  // from what 1 left
  o.get(0);
  CHECK(o.store.decoded_count() == 3);  // kept on the way
  o.get(5);
  CHECK(o.store.decoded_count() == 6);
}

TEST_CASE("without a cache nothing but the group in use stays", "[group_store]") {
  DecodeOptions options;
  options.cache_bytes = 0;
  Opened o(stream(0), options);
  o.get(0);
  const uint64_t one = o.account.used();
  for (size_t g = 1; g < 6; ++g) o.get(g);
  CHECK(o.account.used() < one + one / 4);
  o.get(0);
  CHECK(o.store.decoded_count() == 7);
}

TEST_CASE("old groups make room, and what has no room at all is a limit", "[group_store]") {
  const Bytes file = stream(0);
  const uint64_t enough = [&] {
    Opened o(file);
    o.get(0);
    return o.account.peak();
  }();
  DecodeOptions options;
  options.limits.max_memory = enough + enough / 8;
  Opened tight(file, options);
  for (size_t g = 0; g < 6; ++g) tight.get(g);
  CHECK(tight.account.peak() <= options.limits.max_memory);
  options.limits.max_memory = memory_of_one(tight) / 2;
  Opened poor(file, options);
  std::shared_ptr<const OpenGroup> out;
  CHECK(poor.store.get(poor.request(0), {}, out).code() == StatusCode::kLimitExceeded);
  CHECK(out == nullptr);
  CHECK(poor.account.peak() <= options.limits.max_memory);
}

TEST_CASE("a damaged group fails each time, and costs no other", "[group_store]") {
  Bytes file = stream(0);
  {
    ContainerReader container;
    REQUIRE(container.parse(file, Limits{}).ok());
    const GroupChunk& g = container.groups[2];
    file[g.offset + g.size - 6] ^= 0x55;  // checksum wrong; the store checks it again
  }
  const Bytes sound = stream(0);
  ContainerReader container;
  REQUIRE(container.parse(sound, Limits{}).ok());
  MemorySource source(file);
  MemoryAccount account(UINT64_MAX);
  GroupStore store(source, {}, account);
  const auto status_of = [&](size_t g) {
    std::shared_ptr<const OpenGroup> out;
    GroupRequest request;
    request.run = {container.groups[g]};
    request.reference = container.references[0];
    return store.get(request, {}, out).code();
  };
  CHECK(status_of(2) == StatusCode::kCorrupt);
  CHECK(status_of(2) == StatusCode::kCorrupt);
  CHECK(status_of(1) == StatusCode::kOk);
  CHECK(status_of(3) == StatusCode::kOk);
  CHECK(store.decoded_count() == 2);
}

TEST_CASE("who asks to stop gets nothing, and may ask again", "[group_store]") {
  Opened o(stream(0));
  std::atomic<uint32_t> stops{0};
  const StopToken stop(stops);
  ++stops;
  std::shared_ptr<const OpenGroup> out;
  CHECK(o.store.get(o.request(1), stop, out).code() == StatusCode::kCancelled);
  CHECK(out == nullptr);
  CHECK(o.get(1) != nullptr);
}

TEST_CASE("a group decoded ahead is there when it is asked for", "[group_store]") {
  Opened o(stream(0));
  o.get(0);
  o.store.prefetch(o.request(1));
  // `get` waits where the worker has begun, and does it itself where not.
  const auto group = o.get(1);
  CHECK(group->header.first_frame == kGroupFrames);
  CHECK(o.store.decoded_count() == 2);
  o.store.prefetch(o.request(1));  // nothing to do
  o.get(1);
  CHECK(o.store.decoded_count() == 2);
}

TEST_CASE("faces of a shot are decoded once and stay", "[group_store]") {
  Opened o(stream(0));
  std::shared_ptr<ShotFaces> faces, again;
  REQUIRE(o.store.get_faces(o.container.references[0], {}, faces).ok());
  CHECK(faces->connectivity.face_sizes.size() == torus(18, 11).connectivity.face_sizes.size());
  o.get(4);
  REQUIRE(o.store.get_faces(o.container.references[0], {}, again).ok());
  CHECK(again == faces);
  CHECK(o.get(4)->shot->faces == faces);
}
