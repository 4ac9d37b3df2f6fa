#include "bitstream/container.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "test_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

// The file up to and including HEAD, then the given chunks, without seek table.
Bytes with_chunks(const SequenceHeader& header,
                  const std::vector<std::pair<ChunkType, Bytes>>& chunks) {
  Bytes out;
  ContainerWriter writer(out);
  REQUIRE(writer.begin(header).ok());
  for (const auto& [type, payload] : chunks) append_chunk(out, type, payload);
  return out;
}

Bytes group_payload(const GroupHeader& h) {
  Bytes bytes;
  REQUIRE(write_header(h, "GRUP", bytes).ok());
  return bytes;
}

Bytes reference_payload(uint32_t shot, uint32_t first_frame, uint32_t vertices = 4) {
  ReferenceHeader h;
  h.shot = shot;
  h.first_frame = first_frame;
  Bytes bytes;
  REQUIRE(write_header(h, "REFM", bytes).ok());
  const Bytes mesh = coded_mesh(vertices, 1, 3);
  bytes.insert(bytes.end(), mesh.begin(), mesh.end());
  return bytes;
}

Status parse(const Bytes& file, const Limits& limits = {}) {
  ContainerReader reader;
  return reader.parse(file, limits);
}

}  // namespace

TEST_CASE("a file gives back what was put in", "[container]") {
  const Bytes file = two_shot_file();
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  CHECK(r.format_version == 1);
  CHECK(r.header.total_frames == 10);
  CHECK(r.header.frame_rate == 24.0);
  CHECK(r.metadata == std::vector<MetadataEntry>{{"name", "walk"}, {"unit", "m"}});
  REQUIRE(r.references.size() == 2);
  CHECK(r.references[1].header.first_frame == 7);
  CHECK(r.references[1].mesh_header.vertex_count == 6);
  CHECK(Bytes(r.references[0].mesh.begin(), r.references[0].mesh.end()) == coded_mesh(4, 4, 20));
  REQUIRE(r.groups.size() == 3);
  CHECK(r.groups[0].motion.size() == 3);
  CHECK(Bytes(r.groups[0].coefficients.begin(), r.groups[0].coefficients.end()) == Bytes(40, 2));
  CHECK(Bytes(r.groups[0].basis.begin(), r.groups[0].basis.end()) == Bytes(5, 3));
  CHECK(r.groups[2].header.first_frame == 7);
  CHECK(r.groups[2].header.quantization_step == 0.25f);
  CHECK(r.reference(1) == &r.references[1]);
  CHECK(r.damaged.empty());
  CHECK_FALSE(r.truncated);
}

TEST_CASE("sections add up to the file", "[container]") {
  const Bytes file = two_shot_file();
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  uint64_t sum = 0;
  for (const auto& section : r.sections) sum += section.second;
  CHECK(sum == file.size());
  const auto coefficients = std::find_if(r.sections.begin(), r.sections.end(),
                                         [](const auto& s) { return s.first == "coefficients"; });
  REQUIRE(coefficients != r.sections.end());
  CHECK(coefficients->second == 3 * 40);
}

TEST_CASE("the container of a one-group file is small", "[container]") {
  Bytes file;
  ContainerWriter writer(file);
  SequenceHeader header;
  header.total_frames = 400;
  header.frame_rate = 30;
  const Bytes mesh = coded_mesh(3030, 5664, 3000);
  const Bytes coefficients(2000, 1), basis(900, 1);
  GroupHeader group = group_header(0, 400, 0);
  ReferenceHeader reference;
  REQUIRE(writer.begin(header).ok());
  REQUIRE(writer.reference(reference, mesh).ok());
  REQUIRE(writer.group(group, {{}, coefficients, basis, {}}).ok());
  REQUIRE(writer.finish().ok());
  Bytes headers;
  REQUIRE(write_header(reference, "REFM", headers).ok());
  const size_t framing =
      file.size() - mesh.size() - coefficients.size() - basis.size() - headers.size();
  CHECK(framing <= 90);  // signature, HEAD, chunk framing, group header, seek table and trailer
}

TEST_CASE("unknown chunks are skipped or refused by their case", "[container]") {
  const SequenceHeader header;
  const Bytes group = group_payload(group_header(0, 1, 0));
  const Bytes skipped = with_chunks(header, {{{'n', 'o', 't', 'e'}, {1, 2}},
                                             {kReferenceChunk, reference_payload(0, 0)},
                                             {kGroupChunk, group}});
  ContainerReader r;
  REQUIRE(r.parse(skipped, {}).ok());
  CHECK(r.groups.size() == 1);
  CHECK(r.truncated);  // no seek table: the end is missing
  const Bytes refused = with_chunks(header, {{{'N', 'o', 't', 'e'}, {1, 2}}});
  CHECK(parse(refused).code() == StatusCode::kUnsupported);
}

TEST_CASE("signature and version are checked", "[container]") {
  Bytes file = two_shot_file();
  file[7] = 2;
  CHECK(parse(file).code() == StatusCode::kUnsupported);
  file[1] = 'r';
  CHECK(parse(file).code() == StatusCode::kCorrupt);
  CHECK(parse({}).code() == StatusCode::kTruncated);
  CHECK(parse(Bytes(100, 0)).code() == StatusCode::kCorrupt);
}

TEST_CASE("limits are applied to the headers", "[container]") {
  const Bytes file = two_shot_file();
  Limits limits;
  limits.max_frames = 9;
  CHECK(parse(file, limits).code() == StatusCode::kLimitExceeded);
  limits = {};
  limits.max_vertices = 5;
  CHECK(parse(file, limits).code() == StatusCode::kLimitExceeded);
  limits = {};
  limits.max_faces = 3;
  CHECK(parse(file, limits).code() == StatusCode::kLimitExceeded);
  limits = {6, 4, 10, 10'000};
  CHECK(parse(file, limits).ok());
  limits.max_memory = 1000;  // headers are kept, too
  CHECK(parse(file, limits).code() == StatusCode::kLimitExceeded);
}

TEST_CASE("chunks that contradict each other are corrupt", "[container]") {
  SequenceHeader header;
  header.total_frames = 4;
  header.shot_count = 2;
  const auto ref = [](uint32_t shot, uint32_t first) {
    return std::pair{kReferenceChunk, reference_payload(shot, first)};
  };
  const auto group = [](uint32_t first, uint32_t count, uint32_t shot) {
    return std::pair{kGroupChunk, group_payload(group_header(first, count, shot))};
  };
  using Chunks = std::vector<std::pair<ChunkType, Bytes>>;
  const Chunks cases[] = {
      {group(0, 2, 0)},                             // no reference
      {ref(0, 0), group(1, 2, 0)},                  // a gap
      {ref(0, 0), group(0, 2, 0), group(1, 2, 0)},  // an overlap
      {ref(0, 0), group(0, 5, 0)},                  // past the end
      {ref(0, 0), group(0, 2, 1)},                  // reference of another shot
      {ref(1, 0)},                                  // shot 0 left out
      {ref(0, 0), ref(0, 1)},                       // twice
      {ref(0, 0), ref(1, 0)},                       // a shot without frames
      {ref(0, 0), group(0, 2, 0), ref(1, 3)},       // a shot that starts late
      {{kHeadChunk, {1, 1, 0, 0, 0}}},              // a second sequence header
      {{kGroupChunk, {0, 1, 0}}},                   // half a group header
  };
  for (const Chunks& chunks : cases) {
    CHECK(parse(with_chunks(header, chunks)).code() == StatusCode::kCorrupt);
  }
  CHECK(parse(with_chunks(header, {ref(0, 0), group(0, 2, 0), ref(1, 2), group(2, 2, 1)})).ok());
}

TEST_CASE("sections must fill the group chunk", "[container]") {
  GroupHeader h = group_header(0, 1, 0);
  h.coefficient_bytes = 4;
  for (const size_t filling : {3u, 5u}) {
    Bytes payload = group_payload(h);
    payload.insert(payload.end(), filling, 0);
    const Bytes file = with_chunks(
        SequenceHeader{}, {{kReferenceChunk, reference_payload(0, 0)}, {kGroupChunk, payload}});
    CHECK(parse(file).code() == StatusCode::kCorrupt);
  }
}

TEST_CASE("a wrong seek table is corrupt", "[container]") {
  Bytes file = with_chunks(SequenceHeader{}, {{kReferenceChunk, reference_payload(0, 0)},
                                              {kGroupChunk, group_payload(group_header(0, 1, 0))}});
  append_chunk(file, kSeekChunk, Bytes{1, 3, 9, 0});
  CHECK(parse(file).code() == StatusCode::kCorrupt);
}

TEST_CASE("a whole file with too few frames is corrupt", "[container]") {
  Bytes file;
  ContainerWriter writer(file);
  SequenceHeader header;
  header.total_frames = 3;
  REQUIRE(writer.begin(header).ok());
  REQUIRE(writer.reference({}, coded_mesh(3, 1, 2)).ok());
  REQUIRE(writer.group(group_header(0, 2, 0), {}).ok());
  REQUIRE(writer.finish().ok());
  CHECK(parse(file).code() == StatusCode::kCorrupt);
}

TEST_CASE("the writer refuses fields out of range", "[container]") {
  Bytes out;
  ContainerWriter writer(out);
  SequenceHeader header;
  header.total_frames = 0;
  CHECK(writer.begin(header).code() == StatusCode::kInvalidArgument);
  CHECK(out.empty());
  REQUIRE(writer.begin(SequenceHeader{}).ok());
  CHECK(writer.begin(SequenceHeader{}).code() == StatusCode::kInvalidArgument);
  GroupHeader group;
  group.frame_count = 0;
  CHECK(writer.group(group, {}).code() == StatusCode::kInvalidArgument);
}

TEST_CASE("metadata are added to a whole file", "[container]") {
  const Bytes file = two_shot_file();
  Bytes more;
  REQUIRE(add_metadata(file, {{"unit", "cm"}, {"error", std::string(300, '1')}}, more).ok());
  MemoryAccount account(Limits().max_memory);
  ContainerReader before, after;
  REQUIRE(before.parse(file, {}).ok());
  // Through a source, so that the seek table leads to the chunks.
  MemorySource source(more);
  REQUIRE(after.open(source, {}, account).ok());
  CHECK(after.metadata == std::vector<MetadataEntry>{
                              {"name", "walk"}, {"unit", "cm"}, {"error", std::string(300, '1')}});
  CHECK(after.damaged.empty());
  CHECK_FALSE(after.truncated);
  REQUIRE(after.groups.size() == 3);
  for (size_t i = 0; i < 3; ++i) {
    CHECK(after.groups[i].header == before.groups[i].header);
    // Less the byte by which the first gap of the seek table is longer.
    CHECK(after.groups[i].offset - before.groups[i].offset == more.size() - file.size() - 1);
    Bytes buffer;
    GroupChunk chunk = after.groups[i];
    REQUIRE(load_chunk(source, buffer, chunk).ok());
    CHECK(std::ranges::equal(chunk.coefficients, before.groups[i].coefficients));
  }
  // The same as if they had been there from the start.
  Bytes again;
  REQUIRE(add_metadata(more, {{"name", "walk"}, {"unit", "m"}, {"error", ""}}, again).ok());
  CHECK(again.size() == file.size() + 7);
  for (size_t size = 0; size < file.size(); ++size) {
    CHECK_FALSE(add_metadata(std::span(file).first(size), {{"a", "b"}}, again).ok());
    CHECK(again.empty());
  }
}
