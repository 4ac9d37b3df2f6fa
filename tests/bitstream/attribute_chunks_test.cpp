#include <catch2/catch.hpp>
#include <functional>

#include "bitstream/container.h"

using namespace reeb;

namespace {

using Bytes = std::vector<uint8_t>;

/// A file of one shot of two groups; the hooks write what stands behind the mesh and each group.
struct Hooks {
  std::function<void(ContainerWriter&)> shot = [](auto&) {};
  std::function<void(ContainerWriter&, const GroupHeader&)> group = [](auto&, auto&) {};
};

Bytes file_with(const Hooks& hooks) {
  Bytes out;
  ContainerWriter writer(out);
  SequenceHeader head;
  head.total_frames = 4;
  REQUIRE(writer.begin(head).ok());
  const Bytes mesh = {1, 0, 0, 0, 0, 0};
  REQUIRE(writer.reference({}, mesh).ok());
  hooks.shot(writer);
  for (const uint32_t first : {0u, 2u}) {
    GroupHeader group;
    group.first_frame = first;
    group.frame_count = 2;
    REQUIRE(writer.group(group, {}).ok());
    hooks.group(writer, group);
  }
  REQUIRE(writer.finish().ok());
  return out;
}

AttributeHeader header(uint32_t index, bool animated = false) {
  AttributeHeader h;
  h.index = index;
  h.name = "pressure";
  h.domain = Domain::kFace;
  h.type = ValueType::kU16;
  h.channel_count = 3;
  h.flags = animated ? AttributeHeader::kAnimated : 0;
  return h;
}

StatusCode parse(const Bytes& file) {
  ContainerReader reader;
  return reader.parse(file, {}).code();
}

/// What a file is whose shot has attributes of these indices.
StatusCode with_indices(const std::vector<AttributeHeader>& headers) {
  return parse(file_with({.shot = [&](ContainerWriter& w) {
    for (const AttributeHeader& h : headers) REQUIRE(w.attribute(h, {}, {}).ok());
  }}));
}

}  // namespace

TEST_CASE("attributes, groups of them, resources and bounds are read as written", "[container]") {
  const Bytes values = {1, 2, 3}, sections = {4, 5};
  const Box box{{-1, 0, 1}, {2, 3, 4}};
  const Bytes file =
      file_with({.shot =
                     [&](ContainerWriter& w) {
                       REQUIRE(w.resource({"a.mtl", "model/mtl"}, values).ok());
                       REQUIRE(w.bounds({{box, box}}).ok());
                       REQUIRE(w.attribute(header(0), {{{"x"}}, {}}, values).ok());
                       REQUIRE(w.attribute(header(1, true), {}, {}).ok());
                     },
                 .group =
                     [&](ContainerWriter& w, const GroupHeader& g) {
                       REQUIRE(w.attribute_group({0, 1, g.first_frame, 2}, sections).ok());
                     }});
  ContainerReader reader;
  REQUIRE(reader.parse(file, {}).ok());
  REQUIRE(reader.attributes.size() == 2);
  CHECK(reader.attributes[0].header == header(0));
  CHECK(Bytes(reader.attributes[0].body.begin(), reader.attributes[0].body.end()) ==
        Bytes{1, 1, 'x', 0, 1, 2, 3});
  CHECK(reader.attribute(0, 1) == &reader.attributes[1]);
  CHECK(reader.attribute(0, 2) == nullptr);
  REQUIRE(reader.attribute_groups.size() == 2);
  CHECK(reader.attribute_group(2, 1) == &reader.attribute_groups[1]);
  CHECK(reader.attribute_group(1, 1) == nullptr);
  REQUIRE(reader.resources.size() == 1);
  CHECK(reader.resources[0].header == ResourceHeader{"a.mtl", "model/mtl"});
  CHECK(Bytes(reader.resources[0].bytes.begin(), reader.resources[0].bytes.end()) == values);
  CHECK(reader.bounds == std::vector<Box>{box, box});
  uint64_t sum = 0;
  for (const auto& [name, bytes] : reader.sections) sum += bytes;
  CHECK(sum == file.size());
  CHECK(trace(file).find("name \"pressure\"") != std::string::npos);
}

TEST_CASE("attributes out of place are corrupt", "[container]") {
  CHECK(with_indices({header(0), header(1)}) == StatusCode::kOk);
  CHECK(with_indices({header(1)}) == StatusCode::kCorrupt);
  CHECK(with_indices({header(0), header(0)}) == StatusCode::kCorrupt);
  CHECK(with_indices({header(0), header(2)}) == StatusCode::kCorrupt);
  AttributeHeader other = header(0);
  other.shot = 1;
  CHECK(with_indices({other}) == StatusCode::kCorrupt);

  const auto group_of = [](const AttributeGroupHeader& part, bool animated) {
    return parse(file_with(
        {.shot =
             [&](ContainerWriter& w) { REQUIRE(w.attribute(header(0, animated), {}, {}).ok()); },
         .group =
             [&](ContainerWriter& w, const GroupHeader& g) {
               if (g.first_frame == 2) REQUIRE(w.attribute_group(part, {}).ok());
             }}));
  };
  CHECK(group_of({0, 0, 2, 2}, true) == StatusCode::kOk);
  CHECK(group_of({0, 0, 2, 2}, false) == StatusCode::kCorrupt);
  CHECK(group_of({0, 1, 2, 2}, true) == StatusCode::kCorrupt);
  CHECK(group_of({0, 0, 0, 2}, true) == StatusCode::kCorrupt);
  CHECK(group_of({0, 0, 2, 1}, true) == StatusCode::kCorrupt);
  CHECK(group_of({1, 0, 2, 2}, true) == StatusCode::kCorrupt);

  const auto bounds_of = [](const std::vector<Box>& boxes) {
    return parse(file_with({.shot = [&](ContainerWriter& w) { REQUIRE(w.bounds({boxes}).ok()); }}));
  };
  CHECK(bounds_of({{}, {}}) == StatusCode::kOk);
  CHECK(bounds_of({{}}) == StatusCode::kCorrupt);
  CHECK(bounds_of({{}, {{1, 0, 0}, {0, 0, 0}}}) == StatusCode::kCorrupt);
}

TEST_CASE("names of attributes have a largest length", "[container]") {
  Bytes out;
  ContainerWriter writer(out);
  AttributeHeader h = header(0);
  h.name = std::string(257, 'x');
  CHECK(writer.attribute(h, {}, {}).code() == StatusCode::kInvalidArgument);
  CHECK(writer.resource({"a", std::string(129, 'x')}, {}).code() == StatusCode::kInvalidArgument);
}
