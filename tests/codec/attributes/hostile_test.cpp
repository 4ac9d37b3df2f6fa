#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "bitstream/attribute_group_body.h"
#include "bitstream/container.h"
#include "bitstream/syntax.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "tests/codec/allocation_meter.h"
#include "tests/codec/attributes/samples.h"
#include "tests/codec/damage.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Two shots, every kind of attribute, groups of animated ones, a resource.
Bytes stream(Profile profile) {
  std::mt19937 random(5);
  Shot a = animate(grid(5, 4), 4), b = animate(mixed_polygons(), 2);
  add_all(a, random);
  add_all(b, random);
  for (const Domain domain : {Domain::kVertex, Domain::kCorner, Domain::kFace, Domain::kShot}) {
    Attribute moving = make("moving", domain, ValueType::kBinary32, 4,
                            some<float>(4 * 4 * a.element_count(domain), random, -1, 1, 1e-3));
    moving.animated = true;
    a.attributes.push_back(moving);
    moving.name = "rough";
    moving.max_error = {0.1, 0.1, 0.1, 0.2};
    a.attributes.push_back(moving);
  }
  add_turned_normals(a);
  Sequence sequence = sequence_of({a, b});
  sequence.resources.push_back({"a.png", "image/png", Bytes(50, 7)});
  EncodeOptions options = quick_options();
  options.group_length = 2;
  options.profile = profile;
  return encode_or_fail(sequence, options).bytes;
}

struct Outcome {
  Status opened;
  uint32_t decoded = 0, refused = 0;
};

/// Opens and decodes all attributes of all frames, within the limits.
Outcome probe(const Bytes& bytes) {
  const Limits limits{
      .max_vertices = 2000, .max_faces = 4000, .max_frames = 100, .max_memory = 16u << 20};
  const AllocationMeter meter;
  Outcome out;
  DecodeOptions options;
  options.limits = limits;
  std::unique_ptr<Decoder> decoder;
  out.opened = Decoder::open(bytes, options, decoder);
  if (!out.opened.ok()) return out;
  for (uint32_t frame = 0; frame < std::min(decoder->info().frame_count, 8u); ++frame) {
    std::vector<Attribute> attributes;
    std::vector<uint32_t> indices;
    if (!decoder->attributes(frame, attributes, indices).ok()) continue;
    for (size_t i = 0; i < attributes.size(); ++i) {
      Attribute attribute;
      const Status s = decoder->decode_attribute(frame, indices[i], attribute);
      ++(s.ok() ? out.decoded : out.refused);
    }
  }
  for (uint32_t i = 0; i < decoder->info().resources.size(); ++i) {
    Resource resource;
    (void)decoder->resource(i, resource);
  }
  constexpr size_t kSlack = 4u << 20;  // what is not accounted: models, small lists
  CHECK(meter.peak() <= limits.max_memory + kSlack);
  return out;
}

/// Every whole chunk of a type.
std::vector<Chunk> chunks_of(const Bytes& file, const ChunkType& type) {
  std::vector<Chunk> out;
  Chunk chunk;
  for (uint64_t at = kPreambleBytes;
       at < file.size() && read_chunk(file, at, chunk) == ChunkResult::kFound; at += chunk.size) {
    if (chunk.type == type) out.push_back(chunk);
  }
  return out;
}

}  // namespace

TEST_CASE("damage to an attribute costs that attribute", "[attributes][hostile]") {
  const Bytes whole = stream(Profile::kMain);
  const Outcome all = probe(whole);
  REQUIRE(all.opened.ok());
  REQUIRE(all.refused == 0);
  REQUIRE(all.decoded > 100);
  const Sequence original = decode_or_fail(whole);
  for (const ChunkType& type : {kAttributeChunk, kAttributeGroupChunk, kResourceChunk}) {
    const std::vector<Chunk> chunks = chunks_of(whole, type);
    REQUIRE(!chunks.empty());
    for (const Chunk& chunk : {chunks.front(), chunks.back()}) {
      Bytes bytes = whole;
      bytes[chunk.payload_offset + chunk.payload_size / 2] ^= 0x10;
      std::unique_ptr<Decoder> decoder;
      REQUIRE(Decoder::open(bytes, {}, decoder).ok());
      CHECK(decoder->info().damaged.size() == 1);
      CHECK(decoder->info().damaged[0].type == to_string(type));
      CHECK(decoder->info().missing.empty());
      const Outcome out = probe(bytes);
      CHECK(out.decoded >= all.decoded - 4);  // frames of one attribute
      Sequence decoded;
      const Status s = decode_sequence(bytes, {}, decoded);
      CHECK(s.code() == StatusCode::kCorrupt);
      CHECK((s.message().find(to_string(type)) != std::string::npos ||
             s.message().find("attribute \"") != std::string::npos));
      CHECK(same_positions(decoded, original));
    }
  }
}

TEST_CASE("a stream with attributes cut anywhere is safe", "[attributes][hostile]") {
  const Bytes whole = stream(Profile::kMain);
  for (size_t size = 0; size < whole.size(); size += 1 + size / 97) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
    const Outcome out = probe(cut);
    CHECK((out.opened.ok() || out.opened.code() == StatusCode::kTruncated));
  }
}

TEST_CASE("flipped bits behind right checksums are safe", "[attributes][hostile]") {
  std::mt19937 random(11);
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    const Bytes whole = stream(profile);
    std::vector<Chunk> chunks = chunks_of(whole, kAttributeChunk);
    for (const Chunk& c : chunks_of(whole, kAttributeGroupChunk)) chunks.push_back(c);
    uint32_t refused = 0;
    for (int i = 0; i < 150; ++i) {
      Bytes bytes = whole;
      const Chunk& chunk = chunks[random() % chunks.size()];
      bytes[chunk.payload_offset + random() % chunk.payload_size] ^=
          static_cast<uint8_t>(1u << random() % 8);
      repair_checksums(bytes);
      const Outcome out = probe(bytes);
      refused += out.opened.ok() ? out.refused : 1;
    }
    CHECK(refused > 20);
  }
}

TEST_CASE("bodies of attributes that make no sense are refused", "[attributes][hostile]") {
  const Shape shape = grid(3, 3);
  const ShotSurface surface{shape.connectivity, on_grid(shape, 8)};
  AttributeHeader header;
  header.channel_count = 2;
  header.type = ValueType::kU8;
  ChannelHeader channel;
  const auto decode = [&](const std::vector<ChannelHeader>& channels, const Bytes& section) {
    AttributeBody body;
    body.channels = channels;
    Bytes bytes;
    REQUIRE(write_header(body, "attr", bytes).ok());
    bytes.insert(bytes.end(), section.begin(), section.end());
    AttributeChunk chunk;
    chunk.header = header;
    chunk.body = bytes;
    Attribute out;
    return decode_static_attribute(chunk, surface, {}, out).code();
  };
  CHECK(decode({channel, channel}, Bytes(64)) == StatusCode::kOk);
  CHECK(decode({channel}, Bytes(64)) == StatusCode::kCorrupt);
  CHECK(decode({channel, channel, channel}, Bytes(64)) == StatusCode::kCorrupt);
  channel.top = 1u << 19;
  CHECK(decode({channel, channel}, Bytes(2)) == StatusCode::kCorrupt);  // cut off
  header.type = ValueType::kBinary32;
  channel.top = 0xFFFFFFFF;
  channel.set_low(-5);
  channel.numbers = ChannelHeader::Numbers::kBinary32;
  CHECK(decode({channel, channel}, Bytes(64)) == StatusCode::kCorrupt);
  channel.numbers = ChannelHeader::Numbers::kMultiples;
  channel.step = 1e30;
  CHECK(decode({channel, channel}, Bytes(64)) == StatusCode::kCorrupt);  // beyond binary32
  header.type = ValueType::kU8;
  channel.step = 0.5;
  CHECK(decode({channel, channel}, Bytes(64)) == StatusCode::kCorrupt);
}

TEST_CASE("flags of attributes that make no sense are refused", "[attributes][hostile]") {
  AttributeHeader header;
  header.semantic = Semantic::kNormal;
  header.channel_count = 3;
  uint32_t allowed = 0;
  for (uint32_t flags = 0; flags < 256; ++flags) {
    header.flags = static_cast<uint8_t>(flags);
    Bytes bytes;
    allowed += write_header(header, "attr", bytes).ok() ? 1 : 0;
  }
  CHECK(allowed == 5);  // still, animated; computed, corrected, turning, of animated ones
  header.channel_count = 2;
  header.flags = AttributeHeader::kAnimated | AttributeHeader::kComputed;
  Bytes bytes;
  CHECK(!write_header(header, "attr", bytes).ok());
}
