// Groups that continue the group before.
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "bitstream/container.h"
#include "codec/dec/decoder.h"
#include "tests/codec/damage.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// 30 frames in groups of 5; groups 1 and 2 continue, 3 does not, 4 and 5 do.
EncodeOptions in_runs_of_three() {
  EncodeOptions options = quick_options();
  options.target_value = 0.1;
  options.group_length = 5;
  options.open_groups = 2;
  return options;
}

Sequence thirty_frames() { return sequence_of({animate(torus(18, 11), 30)}); }

std::unique_ptr<Decoder> open(const Bytes& bytes) {
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  return decoder;
}

bool matches(Decoder& decoder, const Sequence& whole, uint32_t frame) {
  const auto expected = whole.shots[0].frame(frame);
  std::vector<float> xyz(expected.size());
  REQUIRE(decoder.decode_frame(frame, xyz.data()).ok());
  return std::memcmp(xyz.data(), expected.data(), xyz.size() * sizeof(float)) == 0;
}

/// The stream with group `index` changed by `edit`, checksums right.
template <class Edit>
Bytes rewritten(const Bytes& bytes, size_t index, Edit edit) {
  ContainerReader in;
  REQUIRE(in.parse(bytes, Limits{}).ok());
  edit(in.groups[index]);
  Bytes out;
  ContainerWriter writer(out);
  REQUIRE(writer.begin(in.header).ok());
  REQUIRE(writer.reference(in.references[0].header, in.references[0].mesh).ok());
  for (const GroupChunk& g : in.groups) REQUIRE(writer.group(g.header, g).ok());
  REQUIRE(writer.finish().ok());
  return out;
}

}  // namespace

TEST_CASE("open groups decode to the same bits in any order", "[open_groups]") {
  const Sequence original = thirty_frames();
  const Encoded out = encode_or_fail(original, in_runs_of_three());
  const Sequence whole = decode_or_fail(out.bytes);
  CHECK(measure(original, whole).kg == Approx(out.stats.kg));
  CHECK(out.stats.kg <= 0.1);
  const auto decoder = open(out.bytes);
  REQUIRE(decoder->info().groups.size() == 6);
  for (size_t i = 0; i < 6; ++i) CHECK(decoder->info().groups[i].continues == (i % 3 != 0));
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    REQUIRE(matches(*decoder, whole, static_cast<uint32_t>(random() % 30)));
  }
  for (uint32_t frame = 30; frame-- > 0;) REQUIRE(matches(*decoder, whole, frame));
  for (const uint32_t frame : {29u, 14u, 7u}) REQUIRE(matches(*open(out.bytes), whole, frame));
}

TEST_CASE("groups of the fast profile decode in any order", "[open_groups]") {
  EncodeOptions options = in_runs_of_three();
  options.open_groups = 0;
  options.profile = Profile::kFast;
  const Encoded out = encode_or_fail(thirty_frames(), options);
  const Sequence whole = decode_or_fail(out.bytes);
  const auto decoder = open(out.bytes);
  REQUIRE(decoder->info().groups.size() == 6);
  for (const StreamInfo::Group& group : decoder->info().groups) CHECK(!group.continues);
  for (const uint32_t frame : {29u, 0u, 14u, 7u}) REQUIRE(matches(*decoder, whole, frame));
}

TEST_CASE("open groups take fewer bytes than closed ones", "[open_groups]") {
  const Sequence sequence = large_sequence();
  EncodeOptions options = quick_options();
  options.target_value = 0.1;
  options.regions = 0;
  options.group_length = 8;
  const size_t closed = encode_or_fail(sequence, options).bytes.size();
  options.open_groups = 63;
  CHECK(encode_or_fail(sequence, options).bytes.size() < closed * 95 / 100);
}

TEST_CASE("a damaged group takes those that continue it along", "[open_groups]") {
  const Encoded out = encode_or_fail(thirty_frames(), in_runs_of_three());
  const Sequence whole = decode_or_fail(out.bytes);
  ContainerReader container;
  REQUIRE(container.parse(out.bytes, Limits{}).ok());
  Bytes damaged = out.bytes;
  damaged[container.groups[1].offset + container.groups[1].size / 2] ^= 1;
  const auto decoder = open(damaged);
  CHECK(decoder->info().groups.size() == 4);
  std::vector<float> xyz(whole.shots[0].frame(0).size());
  for (const uint32_t frame : {7u, 12u}) {
    const Status status = decoder->decode_frame(frame, xyz.data());
    CHECK(status.code() == StatusCode::kCorrupt);
    CHECK(status.message().find("damaged or cut off") != std::string::npos);
  }
  for (const uint32_t frame : {4u, 15u, 29u}) CHECK(matches(*decoder, whole, frame));
}

TEST_CASE("a cut stream plays to its last whole group, open or not", "[open_groups]") {
  const Encoded out = encode_or_fail(thirty_frames(), in_runs_of_three());
  const Sequence whole = decode_or_fail(out.bytes);
  ContainerReader container;
  REQUIRE(container.parse(out.bytes, Limits{}).ok());
  const GroupChunk& last = container.groups[2];
  const Bytes cut(out.bytes.begin(), out.bytes.begin() + last.offset + last.size);
  const auto decoder = open(cut);
  CHECK(decoder->info().frame_count == 15);
  CHECK(matches(*decoder, whole, 14));
}

TEST_CASE("a group cannot continue nothing or another profile", "[open_groups]") {
  const Bytes bytes = encode_or_fail(thirty_frames(), in_runs_of_three()).bytes;
  const Bytes first =
      rewritten(bytes, 0, [](GroupChunk& g) { g.header.flags |= GroupHeader::kContinues; });
  CHECK(open(first)->info().groups.size() == 3);
  const Bytes other = rewritten(bytes, 1, [](GroupChunk& g) { g.header.profile = Profile::kFast; });
  std::vector<float> xyz(size_t{18} * 11 * 3);
  CHECK(open(other)->decode_frame(6, xyz.data()).code() == StatusCode::kCorrupt);
  CHECK(open(other)->decode_frame(3, xyz.data()).ok());
}

TEST_CASE("no more groups continue each other than the format allows", "[open_groups]") {
  Sequence sequence = sequence_of({animate(tetrahedron(), 66)});
  EncodeOptions options = quick_options();
  options.group_length = 1;
  options.open_groups = kMaxOpenGroups;
  Bytes bytes = encode_or_fail(sequence, options).bytes;
  std::vector<float> xyz(12);
  CHECK(open(bytes)->decode_frame(63, xyz.data()).ok());
  bytes = rewritten(bytes, 64, [](GroupChunk& g) { g.header.flags |= GroupHeader::kContinues; });
  CHECK(open(bytes)->decode_frame(63, xyz.data()).ok());
  CHECK(open(bytes)->decode_frame(64, xyz.data()).code() == StatusCode::kCorrupt);
}
