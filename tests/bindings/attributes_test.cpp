#include <catch2/catch.hpp>
#include <cmath>
#include <reeb_attributes.hpp>

#include "tests/bindings/attribute_streams.h"

using namespace reeb;
using namespace reeb::test;

namespace {

struct Closing {
  void operator()(reeb_decoder* d) const { reeb_close(d); }
};
using Handle = std::unique_ptr<reeb_decoder, Closing>;

Handle open(const reeb_options* options = nullptr) {
  const Bytes& bytes = attribute_stream();
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_memory(bytes.data(), bytes.size(), options, &d) == REEB_OK);
  return Handle(d);
}

template <class Struct>
Struct sized() {
  Struct out = {};
  out.struct_size = sizeof out;
  return out;
}

}  // namespace

TEST_CASE("attributes are listed and found", "[c]") {
  const Handle file = open();
  uint32_t count = 0;
  REQUIRE(reeb_get_attribute_count(file.get(), &count) == REEB_OK);
  REQUIRE(count == 5);
  auto a = sized<reeb_attribute>();
  REQUIRE(reeb_get_attribute(file.get(), 1, &a) == REEB_OK);
  CHECK(std::string(a.name) == "usemtl");
  CHECK(a.shot == 0);
  CHECK(a.index == 1);
  CHECK(a.semantic == REEB_SEMANTIC_MATERIAL);
  CHECK(a.domain == REEB_DOMAIN_FACE);
  CHECK(a.type == REEB_TYPE_U16);
  CHECK(a.channels == 1);
  CHECK(a.animated == 0);
  CHECK(a.bytes > 10);
  REQUIRE(reeb_get_attribute(file.get(), 3, &a) == REEB_OK);
  CHECK(a.animated != 0);
  CHECK(a.computed != 0);
  REQUIRE(reeb_get_attribute(file.get(), 4, &a) == REEB_OK);
  CHECK(std::string(a.name) == "id");
  CHECK(a.shot == 1);
  CHECK(a.index == 0);
  CHECK(reeb_get_attribute(file.get(), 5, &a) == REEB_INVALID_ARGUMENT);

  uint32_t index = 99;
  CHECK(reeb_find_attribute(file.get(), 2, "heat", &index) == REEB_OK);
  CHECK(index == 2);
  CHECK(reeb_find_attribute(file.get(), 3, "heat", &index) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_find_attribute(file.get(), 3, "id", &index) == REEB_OK);
  CHECK(index == 0);
  CHECK(reeb_find_semantic(file.get(), 0, REEB_SEMANTIC_NORMAL, &index) == REEB_OK);
  CHECK(index == 3);
  CHECK(reeb_find_semantic(file.get(), 0, REEB_SEMANTIC_COLOUR, &index) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_find_semantic(file.get(), 4, REEB_SEMANTIC_NORMAL, &index) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("names of values come whole or cut", "[c]") {
  const Handle file = open();
  char name[4];
  size_t length = 0;
  REQUIRE(reeb_get_name(file.get(), 0, 1, 1, name, sizeof name, &length) == REEB_OK);
  CHECK(std::string(name) == "cla");
  CHECK(length == 4);
  CHECK(reeb_get_name(file.get(), 0, 1, 0, nullptr, 0, nullptr) == REEB_OK);
  CHECK(reeb_get_name(file.get(), 0, 1, 2, name, sizeof name, &length) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_name(file.get(), 0, 9, 0, name, sizeof name, &length) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("values go where the caller wants them", "[c]") {
  const Handle file = open();
  std::vector<float> values(16 * 3, -1.0f);  // two channels of every vertex, among others' bytes
  reeb_value_target target = {sizeof target, values.data(), 3 * sizeof(float), 16};
  REQUIRE(reeb_get_values(file.get(), 2, 2, &target) == REEB_OK);
  for (size_t v = 0; v < 16; ++v) {
    CHECK(values[3 * v] == static_cast<float>(64 + 2 * v));
    CHECK(values[3 * v + 1] == static_cast<float>(65 + 2 * v));
    CHECK(values[3 * v + 2] == -1);
  }
  int32_t ids[4] = {};
  reeb_value_target id_target = {sizeof id_target, ids, 0, 4};
  REQUIRE(reeb_get_values(file.get(), 3, 0, &id_target) == REEB_OK);
  CHECK(ids[0] == -7);
  CHECK(ids[1] == 1 << 30);

  target.element_capacity = 15;
  CHECK(reeb_get_values(file.get(), 2, 2, &target) == REEB_INVALID_ARGUMENT);
  target.element_capacity = 16;
  target.stride = 7;
  CHECK(reeb_get_values(file.get(), 2, 2, &target) == REEB_INVALID_ARGUMENT);
  target.stride = 0;
  CHECK(reeb_get_values(file.get(), 2, 7, &target) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_values(file.get(), 4, 0, &target) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_values(file.get(), 2, 2, nullptr) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_values(nullptr, 2, 2, &target) == REEB_INVALID_ARGUMENT);
  target.values = nullptr;
  CHECK(reeb_get_values(file.get(), 2, 2, &target) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("resources, bounds and many frames come through the C interface", "[c]") {
  const Handle file = open();
  uint32_t count = 0;
  REQUIRE(reeb_get_resource_count(file.get(), &count) == REEB_OK);
  REQUIRE(count == 1);
  const char *name = nullptr, *media_type = nullptr;
  REQUIRE(reeb_get_resource(file.get(), 0, &name, &media_type) == REEB_OK);
  CHECK(std::string(name) == "a.mtl");
  CHECK(std::string(media_type) == "model/mtl");
  uint8_t bytes[3] = {9, 9, 9};
  size_t length = 0;
  REQUIRE(reeb_get_resource_bytes(file.get(), 0, bytes, 2, &length) == REEB_OK);
  CHECK(length == 3);
  CHECK(bytes[1] == 2);
  CHECK(bytes[2] == 9);
  CHECK(reeb_get_resource(file.get(), 1, &name, &media_type) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_resource_bytes(file.get(), 1, bytes, 2, &length) == REEB_INVALID_ARGUMENT);

  const Sequence sequence = attribute_sequence();
  std::vector<float> xyz(3 * 48);
  REQUIRE(reeb_get_frames(file.get(), 0, 3, xyz.data(), 48) == REEB_OK);
  CHECK(xyz == sequence.shots[0].positions);
  CHECK(reeb_get_frames(file.get(), 0, 3, xyz.data(), 47) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_frames(file.get(), 3, 2, xyz.data(), 48) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_frames(file.get(), 0, 1, nullptr, 48) == REEB_INVALID_ARGUMENT);
  float low[3], high[3];
  REQUIRE(reeb_get_bounds(file.get(), 0, low, high) == REEB_OK);
  for (size_t axis = 0; axis < 3; ++axis) {
    float least = xyz[axis], most = xyz[axis];
    for (size_t i = axis; i < xyz.size(); i += 3) {
      least = std::min(least, sequence.shots[0].positions[i]);
      most = std::max(most, sequence.shots[0].positions[i]);
    }
    CHECK(low[axis] == least);
    CHECK(high[axis] == most);
  }
  CHECK(reeb_get_bounds(file.get(), 9, low, high) == REEB_INVALID_ARGUMENT);
}

TEST_CASE("a render mesh is split at seams and sorted by material", "[c]") {
  const Handle file = open();
  const uint32_t split_by[] = {0, 2};  // of vertices: splits nothing
  reeb_render_mesh* mesh = nullptr;
  REQUIRE(reeb_make_render_mesh(file.get(), 0, split_by, 2, &mesh) == REEB_OK);
  auto info = sized<reeb_render_info>();
  REQUIRE(reeb_get_render_info(mesh, &info) == REEB_OK);
  CHECK(info.vertex_count == 24);  // three strips of 2 by 4
  CHECK(info.triangle_count == 18);
  CHECK(info.material_attribute == 1);
  REQUIRE(info.range_count == 2);
  int64_t material = -1;
  size_t first = 0, triangles = 0;
  REQUIRE(reeb_get_render_range(mesh, 1, &material, &first, &triangles) == REEB_OK);
  CHECK(material == 1);
  CHECK(first == 6);
  CHECK(triangles == 12);
  CHECK(reeb_get_render_range(mesh, 2, &material, &first, &triangles) == REEB_INVALID_ARGUMENT);

  const Sequence sequence = attribute_sequence();
  std::vector<float> xyz(24 * 3), normals(24 * 4, 5.0f);
  auto target = sized<reeb_target>();
  target.positions = xyz.data();
  target.normals = normals.data();
  target.normal_stride = 4;
  target.vertex_capacity = 24;
  REQUIRE(reeb_get_render_frame(file.get(), 1, mesh, &target) == REEB_OK);
  const std::span<const float> frame = sequence.shots[0].frame(1);
  for (size_t i = 0; i < 24; ++i) {
    for (size_t axis = 0; axis < 3; ++axis)
      CHECK(xyz[3 * i + axis] == frame[3 * info.source_vertices[i] + axis]);
    CHECK(std::hypot(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]) == Approx(1));
    CHECK(normals[4 * i + 3] == 5);
  }
  REQUIRE(reeb_get_render_between(file.get(), 0.5, mesh, &target) == REEB_OK);
  const size_t v = info.source_vertices[7];
  const float a = sequence.shots[0].frame(0)[3 * v], b = frame[3 * v];
  CHECK(xyz[3 * 7] == Approx((a + b) / 2));

  std::vector<uint8_t> rows(24);
  reeb_value_target values = {sizeof values, rows.data(), 0, 24};
  REQUIRE(reeb_get_render_values(file.get(), 1, 0, mesh, &values) == REEB_OK);
  for (size_t i = 0; i < 24; ++i) CHECK(rows[i] == info.source_corners[i] / 12);
  uint16_t materials[18];
  reeb_value_target of_faces = {sizeof of_faces, materials, 0, 18};
  REQUIRE(reeb_get_render_values(file.get(), 1, 1, mesh, &of_faces) == REEB_OK);
  for (size_t i = 0; i < 18; ++i) CHECK(materials[i] == (i < 6 ? 0 : 1));

  CHECK(reeb_get_render_values(file.get(), 3, 0, mesh, &values) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_render_frame(file.get(), 3, mesh, &target) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_render_between(file.get(), -1, mesh, &target) == REEB_INVALID_ARGUMENT);
  target.vertex_capacity = 23;
  CHECK(reeb_get_render_frame(file.get(), 1, mesh, &target) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_render_frame(file.get(), 1, nullptr, &target) == REEB_INVALID_ARGUMENT);
  CHECK(reeb_get_render_info(nullptr, &info) == REEB_INVALID_ARGUMENT);
  const uint32_t wrong[] = {9};
  reeb_render_mesh* none = mesh;
  CHECK(reeb_make_render_mesh(file.get(), 0, wrong, 1, &none) == REEB_INVALID_ARGUMENT);
  CHECK(none == nullptr);
  CHECK(reeb_make_render_mesh(file.get(), 0, nullptr, 1, &none) == REEB_INVALID_ARGUMENT);
  reeb_free_render_mesh(mesh);
  reeb_free_render_mesh(nullptr);
}

TEST_CASE("computed normals keep their hard edges in a render mesh", "[c]") {
  const Handle file = open();
  const Shot shot = attribute_sequence().shots[0];
  const uint32_t split_by[] = {3};
  reeb_render_mesh* mesh = nullptr;
  REQUIRE(reeb_make_render_mesh(file.get(), 2, split_by, 1, &mesh) == REEB_OK);
  auto info = sized<reeb_render_info>();
  REQUIRE(reeb_get_render_info(mesh, &info) == REEB_OK);
  REQUIRE(info.vertex_count == 24);
  for (const uint32_t frame : {0u, 2u}) {
    std::vector<float> normals(24 * 3);
    reeb_value_target target = {sizeof target, normals.data(), 0, 24};
    REQUIRE(reeb_get_render_values(file.get(), frame, 3, mesh, &target) == REEB_OK);
    for (size_t i = 0; i < 24; ++i) {
      const Vector n =
          row_normal(shot, frame, info.source_corners[i] / 12, info.source_vertices[i]);
      for (size_t a = 0; a < 3; ++a) CHECK(std::abs(double{normals[3 * i + a]} - n[a]) < 1e-6);
    }
  }
  reeb_free_render_mesh(mesh);
}

TEST_CASE("what attributes take counts for the limit of memory", "[c]") {
  const Handle file = open();
  const auto memory = [&] {
    auto stats = sized<reeb_stats>();
    REQUIRE(reeb_get_stats(file.get(), &stats) == REEB_OK);
    return stats.memory;
  };
  const uint32_t split_by[] = {0};
  reeb_render_mesh* mesh = nullptr;
  REQUIRE(reeb_make_render_mesh(file.get(), 0, split_by, 1, &mesh) == REEB_OK);
  const uint64_t with_mesh = memory();
  reeb_free_render_mesh(mesh);
  // Two numbers of each render vertex, four of each triangle.
  CHECK(with_mesh - memory() >= 4 * (24 * 2 + 18 * 4));

  auto options = sized<reeb_options>();
  options.limits.max_memory = 500'000;
  const Handle small = open(&options);
  CHECK(reeb_make_render_mesh(small.get(), 0, split_by, 1, &mesh) == REEB_LIMIT_EXCEEDED);
  uint8_t rows[36];
  const reeb_value_target target = {sizeof target, rows, 0, 36};
  CHECK(reeb_get_values(small.get(), 0, 0, &target) == REEB_LIMIT_EXCEEDED);
}

TEST_CASE("values of pushed bytes come when they are there", "[c]") {
  const Bytes& bytes = attribute_stream();
  reeb_decoder* d = nullptr;
  REQUIRE(reeb_open_push(nullptr, &d) == REEB_OK);
  const Handle file(d);
  uint32_t count = 7;
  CHECK(reeb_get_attribute_count(d, &count) == REEB_NEED_MORE_DATA);
  std::vector<float> heat(32);
  const reeb_value_target target = {sizeof target, heat.data(), 0, 16};
  bool waited = false, came = false;
  for (const uint8_t byte : bytes) {
    REQUIRE(reeb_push(d, &byte, 1) == REEB_OK);
    const reeb_result result = came ? REEB_OK : reeb_get_values(d, 1, 2, &target);
    if (result == REEB_NEED_MORE_DATA) waited = true;
    if (result == REEB_OK) came = true;
    if (result != REEB_OK && result != REEB_NEED_MORE_DATA) FAIL(reeb_result_string(result));
  }
  CHECK(waited);
  CHECK(came);
  CHECK(heat[5] == 37);
}

TEST_CASE("the C++ interface has attributes and meshes for rendering", "[cpp]") {
  Stream stream;
  REQUIRE(stream.open_memory(attribute_stream().data(), attribute_stream().size()) == REEB_OK);
  const std::vector<reeb_attribute> all = attributes(stream);
  REQUIRE(all.size() == 5);
  std::vector<float> heat;
  REQUIRE(values(stream, 1, all[2], 16, heat) == REEB_OK);
  CHECK(heat.size() == 32);
  CHECK(heat[5] == 37);
  std::vector<uint16_t> narrow;
  CHECK(values(stream, 1, all[2], 16, narrow) == REEB_INVALID_ARGUMENT);
  CHECK(name_of_value(stream, 0, 1, 1) == "claw");
  CHECK(name_of_value(stream, 0, 1, 2).empty());
  StreamResource file;
  REQUIRE(resource(stream, 0, file) == REEB_OK);
  CHECK(file.name == "a.mtl");
  CHECK(file.bytes == std::vector<uint8_t>{1, 2, 3});
  std::vector<float> xyz;
  REQUIRE(frames(stream, 1, 2, 16, xyz) == REEB_OK);
  CHECK(xyz.size() == 96);
  CHECK(xyz[48] == attribute_sequence().shots[0].frame(2)[0]);

  StreamRenderMesh mesh;
  CHECK_FALSE(mesh);
  REQUIRE(mesh.make(stream, 0, {0, 3}) == REEB_OK);
  CHECK(mesh.info().vertex_count == 24);
  REQUIRE(mesh.ranges().size() == 2);
  CHECK(mesh.ranges()[0].count == 6);
  std::vector<float> normals, wedge_normals;
  REQUIRE(mesh.between(stream, 1.5, xyz, &normals) == REEB_OK);
  CHECK(xyz.size() == 72);
  REQUIRE(mesh.values(stream, 1, all[3], wedge_normals) == REEB_OK);
  CHECK(wedge_normals.size() == 72);
  CHECK(mesh.make(stream, 0, {9}) == REEB_INVALID_ARGUMENT);
  CHECK_FALSE(mesh);
}
