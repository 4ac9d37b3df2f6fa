// A small whole file for the container tests: two shots, three groups, metadata.
#pragma once

#include <catch2/catch.hpp>
#include <vector>

#include "bitstream/container.h"
#include "bitstream/syntax.h"

namespace reeb::test {

using Bytes = std::vector<uint8_t>;

inline Bytes coded_mesh(uint32_t vertices, uint32_t faces, size_t filling) {
  MeshHeader h;
  h.vertex_count = vertices;
  h.face_count = faces;
  h.rest_bytes = filling;
  Bytes bytes;
  REQUIRE(write_header(h, "mesh", bytes).ok());
  bytes.insert(bytes.end(), filling, 0xA5);
  return bytes;
}

inline GroupHeader group_header(uint32_t first, uint32_t frames, uint32_t shot) {
  GroupHeader h;
  h.first_frame = first;
  h.frame_count = frames;
  h.shot = shot;
  h.component_count = 5;
  h.quantization_step = 0.25f;
  return h;
}

inline Bytes two_shot_file() {
  Bytes out;
  ContainerWriter writer(out);
  SequenceHeader header;
  header.total_frames = 10;
  header.shot_count = 2;
  header.frame_rate = 24;
  const Bytes motion(3, 1), coefficients(40, 2), basis(5, 3);
  ReferenceHeader second;
  second.shot = 1;
  second.first_frame = 7;
  REQUIRE(writer.begin(header).ok());
  REQUIRE(writer.metadata({{"name", "walk"}, {"unit", "m"}}).ok());
  REQUIRE(writer.reference(ReferenceHeader{}, coded_mesh(4, 4, 20)).ok());
  REQUIRE(writer.group(group_header(0, 4, 0), {motion, coefficients, basis, {}}).ok());
  REQUIRE(writer.group(group_header(4, 3, 0), {{}, coefficients, {}, {}}).ok());
  REQUIRE(writer.reference(second, coded_mesh(6, 2, 10)).ok());
  REQUIRE(writer.group(group_header(7, 3, 1), {{}, coefficients, basis, {}}).ok());
  REQUIRE(writer.finish().ok());
  return out;
}

}  // namespace reeb::test
