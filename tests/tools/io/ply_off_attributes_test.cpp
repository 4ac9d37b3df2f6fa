#include <catch2/catch.hpp>
#include <climits>

#include "tests/tools/io/read_mesh_text.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/attribute_values.h"

namespace reeb::tools {
namespace {

using Catch::Contains;

const Attribute& attribute(const MeshFrame& frame, const std::string& name) {
  const Attribute* a = attribute_named(frame.attributes, name);
  INFO(name);
  REQUIRE(a != nullptr);
  return *a;
}

std::vector<double> stored(const Attribute& a) {
  std::vector<double> out;
  for (size_t i = 0; i * size_of(a.type) < a.values.size(); ++i) out.push_back(stored_number(a, i));
  return out;
}

std::string ply(const std::string& vertex, const std::string& face, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\n" +
         vertex + "element face 1\nproperty list uchar int vertex_indices\n" + face +
         "end_header\n" + rows;
}

}  // namespace

TEST_CASE("PLY: properties that belong together are one attribute, of any type") {
  const MeshFrame frame = read_ok(
      ply("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float nx\n"
          "property float ny\nproperty float nz\nproperty double heat\nproperty short turn\n"
          "property uint id\nproperty float s\nproperty float t\nproperty ushort green\n",
          "property int material_index\nproperty float area\nproperty list uchar float texcoord\n",
          "0 0 0 255 0 1 0 0 1 0.1 -5 4294967295 0.25 0.5 65535\n"
          "1 0 0 2 3 4 0 1 0 2 6 7 0 0 1\n0 1 0 5 6 7 1 0 0 nan 0 2147483647 1 1 0\n"
          "3 0 1 2 42 0.5 2 0 1\n"),
      MeshFormat::kPly);
  const Attribute& colour = attribute(frame, "red green blue");
  CHECK(colour.type == ValueType::kU8Normalised);
  CHECK(colour.semantic == Semantic::kColour);
  CHECK(stored(colour) == std::vector<double>{255, 0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(attribute(frame, "nx ny nz").semantic == Semantic::kNormal);
  CHECK(attribute(frame, "s t").semantic == Semantic::kTextureCoordinate);
  CHECK(stored(attribute(frame, "heat")) == std::vector<double>{double{0.1f}, 2, 0});
  CHECK(stored(attribute(frame, "turn")) == std::vector<double>{-5, 6, 0});
  CHECK(stored(attribute(frame, "id")) == std::vector<double>{INT_MAX, 7, INT_MAX});
  CHECK(attribute(frame, "green").type == ValueType::kU16);
  CHECK(attribute(frame, "material_index").semantic == Semantic::kMaterial);
  CHECK(stored(attribute(frame, "area")) == std::vector<double>{0.5});
  CHECK(attribute(frame, "area").domain == Domain::kFace);
  CHECK(frame.unkept == std::vector<Unkept>{{"list texcoord", 1}});
  REQUIRE(frame.notes.size() == 2);
  CHECK_THAT(frame.notes[0], Contains("1 number of \"heat\" rounded to binary32"));
  CHECK_THAT(frame.notes[1], Contains("1 number of \"id\" beyond 32 bits"));
}

TEST_CASE("PLY and OFF: attributes are written back as they were read") {
  const TestMesh mesh = plain_mesh();
  const std::vector<Attribute> attributes{
      make_attribute("red green blue alpha", Semantic::kColour, Domain::kVertex,
                     ValueType::kU8Normalised, 4,
                     std::vector<uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 255}),
      make_attribute("heat", Semantic::kGeneric, Domain::kVertex, ValueType::kBinary32, 1,
                     std::vector<float>{0.1f, -2, 3e-9f, 4}),
      make_attribute("id", Semantic::kGeneric, Domain::kFace, ValueType::kI32, 1,
                     std::vector<int32_t>{-1, 1 << 30}),
      make_attribute("count", Semantic::kGeneric, Domain::kFace, ValueType::kU16, 1,
                     std::vector<uint16_t>{65535, 7})};
  std::vector<std::string> unkept;
  const MeshFrame back =
      read_ok(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly, attributes, &unkept),
              MeshFormat::kPly);
  CHECK(back.attributes == attributes);
  CHECK(unkept.empty());
  CHECK(back.notes.empty());

  const MeshFrame off =
      read_ok(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kOff, attributes, &unkept),
              MeshFormat::kOff);
  REQUIRE(off.attributes.size() == 1);
  CHECK(off.attributes[0].values == attributes[0].values);
  CHECK(unkept == std::vector<std::string>{"heat", "id", "count"});
}

TEST_CASE("PLY: corners go to vertices where they agree, and it is said where they do not") {
  const TestMesh mesh = plain_mesh();
  std::vector<float> uv{0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  const auto write = [&](std::vector<std::string>& unkept) {
    const std::vector<Attribute> attributes{make_attribute(
        "vt", Semantic::kTextureCoordinate, Domain::kCorner, ValueType::kBinary32, 2, uv)};
    return read_ok(
        write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly, attributes, &unkept),
        MeshFormat::kPly);
  };
  std::vector<std::string> unkept;
  CHECK(stored(attribute(write(unkept), "s t")) == std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1});
  CHECK(unkept.empty());
  uv[0] = 0.5f;
  CHECK(write(unkept).attributes.empty());
  CHECK(unkept == std::vector<std::string>{"vt"});
}

TEST_CASE("PLY: names of hostile origin become words of their own") {
  const TestMesh mesh = plain_mesh();
  const std::vector<float> values(4, 1);
  std::vector<Attribute> attributes;
  for (const char* name : {"x", "a\nend_header\n", "x", ""})
    attributes.push_back(
        make_attribute(name, Semantic::kGeneric, Domain::kVertex, ValueType::kBinary32, 1, values));
  const MeshFrame back =
      read_ok(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly, attributes),
              MeshFormat::kPly);
  CHECK(back.positions == mesh.positions);
  CHECK(back.attributes.size() == 4);
}

TEST_CASE("OFF: normals, colours and texture coordinates, in any combination") {
  const MeshFrame all = read_ok(
      "STCNOFF 3 1 0\n0 0 0 0 0 1 1 .5 0 1 .25 .5\n1 0 0 0 1 0 0 0 0 1 0 0\n"
      "0 1 0 1 0 0 0 0 1 .5 1 1\n3 0 1 2 255 128 0\n",
      MeshFormat::kOff);
  CHECK(stored(attribute(all, "normal")) == std::vector<double>{0, 0, 1, 0, 1, 0, 1, 0, 0});
  CHECK(stored(attribute(all, "color")) ==
        std::vector<double>{1, 0.5, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0.5});
  CHECK(stored(attribute(all, "st")) == std::vector<double>{0.25, 0.5, 0, 0, 1, 1});
  const Attribute& face = attribute(all, "face color");
  CHECK(face.domain == Domain::kFace);
  CHECK(face.type == ValueType::kU8Normalised);
  CHECK(stored(face) == std::vector<double>{255, 128, 0});
  CHECK(all.unkept.empty());

  const MeshFrame words = read_ok(
      "COFF 3 1 0 0 0 0 0 0 255 255 1 0 0 0 0 255 255 0 1 0 9 0 255 "
      "255 3 0 1 2",
      MeshFormat::kOff);
  CHECK(attribute(words, "color").type == ValueType::kU8Normalised);
  CHECK(stored(attribute(words, "color")).size() == 12);
  const std::string text =
      write_mesh(all.connectivity, all.positions, MeshFormat::kOff, all.attributes);
  CHECK(text.starts_with("STCNOFF\n3 1 0\n0 0 0 0 0 1 1 0.5 0 1 0.25 0.5\n"));
  CHECK(read_ok(text, MeshFormat::kOff).attributes == all.attributes);
}

}  // namespace reeb::tools
