#include <catch2/catch.hpp>

#include "tests/tools/io/read_mesh_text.h"
#include "tests/tools/temp_folder.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/attribute_values.h"
#include "tools/io/material_files.h"
#include "tools/io/obj_faces.h"
#include "tools/io/read_sequence.h"

namespace reeb::tools {
namespace {

using Catch::Contains;

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

const Attribute& named(const std::vector<Attribute>& attributes, const std::string& name) {
  const Attribute* a = attribute_named(attributes, name);
  INFO(name);
  REQUIRE(a != nullptr);
  return *a;
}

std::vector<float> numbers(const Attribute& a) {
  std::vector<float> out;
  for (size_t i = 0; i * size_of(a.type) < a.values.size(); ++i) out.push_back(number_of(a, i));
  return out;
}

std::vector<float> numbers(const MeshFrame& frame, const std::string& name) {
  return numbers(named(frame.attributes, name));
}

Sequence read_frames(const std::vector<std::string>& frames, const ReadOptions& options = {},
                     std::vector<std::string>* notes = nullptr) {
  const TempFolder folder;
  for (size_t i = 0; i < frames.size(); ++i)
    folder.write(std::string("f").append(std::to_string(i + 1)).append(".obj"), frames[i]);
  Sequence out;
  ReadReport report;
  const Status status = read_sequence({folder.path().string()}, options, out, report);
  INFO(status.message());
  REQUIRE(status.ok());
  if (notes != nullptr) *notes = report.notes;
  return out;
}

}  // namespace

TEST_CASE("OBJ: corners have the entries that they name, from either end of the list") {
  const MeshFrame frame =
      read_ok(kVertices +
                  "vt 0.25 0.5\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/-1/-1\nvt 7 8\n"
                  "f 1/3/1 3/-3/1 4/-1/1\n",
              MeshFormat::kObj);
  const Attribute& vt = named(frame.attributes, "vt");
  CHECK(vt.semantic == Semantic::kTextureCoordinate);
  CHECK(vt.domain == Domain::kCorner);
  CHECK(vt.channel_count == 2);
  CHECK(numbers(vt) == std::vector<float>{0.25f, 0.5f, 1, 0, 1, 0, 7, 8, 0.25f, 0.5f, 7, 8});
  const Attribute& vn = named(frame.attributes, "vn");
  CHECK(vn.semantic == Semantic::kNormal);
  CHECK(numbers(vn).size() == 18);
  CHECK(frame.attributes.size() == 2);
  CHECK(frame.unkept.empty());
}

TEST_CASE("OBJ: one to three numbers are a texture coordinate") {
  const auto channels = [](const std::string& list) {
    return named(read_ok(kVertices + list + "f 1/1 2/1 3/2\n", MeshFormat::kObj).attributes, "vt")
        .channel_count;
  };
  CHECK(channels("vt 0.5\nvt 1\n") == 1);
  CHECK(channels("vt 0.5\nvt 1 2\n") == 2);
  CHECK(channels("vt 0.5 0 1\nvt 1 2\n") == 3);
  const MeshFrame more = read_ok(kVertices + "vt 1 2 3 4 5\nf 1/1 2/1 3/1\n", MeshFormat::kObj);
  CHECK(more.unkept == std::vector<Unkept>{{"further numbers of texture coordinates", 2}});
}

TEST_CASE("OBJ: faces have the material, groups and smoothing of the statements before them") {
  const MeshFrame frame = read_ok("g default\n" + kVertices +
                                      "f 1 2 3\ng a  b\nusemtl red#1 dark\ns 3\nf 1 2 3\n"
                                      "usemtl blue\no thing\ns off\nf 1 2 3\ng\nusemtl red#1 dark\n"
                                      "s on\nf 1 2 4\ng spare\n",
                                  MeshFormat::kObj);
  CHECK(named(frame.attributes, "usemtl").semantic == Semantic::kMaterial);
  CHECK(named(frame.attributes, "usemtl").names == std::vector<std::string>{"red#1 dark", "blue"});
  CHECK(numbers(frame, "usemtl") == std::vector<float>{-1, 0, 1, 0});
  CHECK(named(frame.attributes, "g").names == std::vector<std::string>{"default", "a b"});
  CHECK(numbers(frame, "g") == std::vector<float>{0, 1, 1, -1});
  CHECK(numbers(frame, "o") == std::vector<float>{-1, -1, 0, 0});
  CHECK(numbers(frame, "s") == std::vector<float>{0, 3, 0, 1});
  CHECK(frame.unkept == std::vector<Unkept>{{"groups without faces", 1}});
}

TEST_CASE("OBJ: vertices have colours or weights") {
  const MeshFrame colours =
      read_ok("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 nan\nf 1 2 3\n", MeshFormat::kObj);
  CHECK(named(colours.attributes, "color").semantic == Semantic::kColour);
  CHECK(numbers(colours, "color") == std::vector<float>{1, 0.5f, 0, 1, 1, 1, 0, 0, 0});
  CHECK(colours.notes.size() == 2);
  const MeshFrame weights = read_ok("v 0 0 0 1\nv 1 0 0\nv 0 1 0 2\n", MeshFormat::kObj);
  CHECK(numbers(weights, "w") == std::vector<float>{1, 1, 2});
  CHECK(read_ok("v 0 0 0 1\nv 1 0 0 1\n", MeshFormat::kObj).attributes.empty());
}

TEST_CASE("OBJ: what corners lack or cannot have is told") {
  const MeshFrame partly = read_ok(
      kVertices + "vt 1 2\nvt 3 4\nf 1/1 2/2 3\nf 1/1 2/1 3/1\nf 1/1 2/9 3/-5\n", MeshFormat::kObj);
  CHECK(numbers(partly, "vt.none") == std::vector<float>{1, 0, 1});
  CHECK(partly.unkept ==
        std::vector<Unkept>{{"texture coordinates that the file does not have", 2},
                            {"texture coordinates of faces that have them at some corners only", 3},
                            {"texture coordinates of no corner", 1}});
  const MeshFrame none = read_ok(kVertices + "vt 1 2\nf 1 2 3\n", MeshFormat::kObj);
  CHECK(none.attributes.empty());
  CHECK(none.unkept == std::vector<Unkept>{{"texture coordinates of no corner", 1}});
  const MeshFrame bad =
      read_ok(kVertices + "vn nan(ind) 0 1\nf 1//1 2//1 3//1\n", MeshFormat::kObj);
  CHECK(numbers(bad, "vn") == std::vector<float>(9, 0.0f));
  CHECK_THAT(bad.notes.at(0), Contains("1 entry of the normals not finite"));
  CHECK_THAT(failure(kVertices + "vn 0 1\n", MeshFormat::kObj), Contains("line 5"));
}

TEST_CASE("OBJ: names in another code are taken as Latin-1") {
  const MeshFrame frame = read_ok(kVertices + "usemtl K\xf6rper\nf 1 2 3\n", MeshFormat::kObj);
  CHECK(named(frame.attributes, "usemtl").names == std::vector<std::string>{"K\xc3\xb6rper"});
  CHECK(frame.notes.size() == 1);
}

TEST_CASE("OBJ: a frame whose faces have the text of an earlier one has its own values") {
  const std::string faces = "f 1/1 2/2 3/3\nusemtl b\nf 1/-1 3/-2 4/-3\nmtllib late.mtl\n";
  const std::string lists = "vt 0 0\nvt 1 0\nvt 1 1\n";
  const Sequence same =
      read_frames({"usemtl a\n" + kVertices + lists + faces,
                   "usemtl a\n" + kVertices + "vt 0 0\nvt 1 0\nvt 1 2\n" + faces});
  REQUIRE(same.shots.size() == 1);
  const auto& attributes = same.shots[0].attributes;
  CHECK(named(attributes, "vt").animated);
  CHECK(numbers(named(attributes, "vt")) ==
        std::vector<float>{0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0,  //
                           0, 0, 1, 0, 1, 2, 1, 2, 1, 0, 0, 0});
  CHECK_FALSE(named(attributes, "usemtl").animated);
  CHECK(named(attributes, "mtllib").names == std::vector<std::string>{"late.mtl"});
  // The same text means other entries and another material.
  const Sequence other = read_frames({"usemtl a\n" + kVertices + lists + faces,
                                      "usemtl c\n" + kVertices + lists + "vt 5 5\n" + faces});
  REQUIRE(other.shots.size() == 1);
  const Attribute& material = named(other.shots[0].attributes, "usemtl");
  CHECK(material.names == std::vector<std::string>{"a", "b", "c"});
  CHECK(numbers(material) == std::vector<float>{0, 1, 2, 1});
  const std::vector<float> vt = numbers(named(other.shots[0].attributes, "vt"));
  CHECK(std::vector<float>(vt.begin() + 18, vt.end()) == std::vector<float>{5, 5, 1, 1, 1, 0});
}

TEST_CASE("OBJ: another set of attributes starts a new reference") {
  std::vector<std::string> notes;
  const std::string bare = kVertices + "f 1 2 3\n";
  const std::string with = kVertices + "vt 1 2\nf 1/1 2/1 3/1\n";
  const Sequence sequence = read_frames({bare, with, with, bare}, {}, &notes);
  REQUIRE(sequence.shots.size() == 3);
  CHECK(sequence.shots[1].frame_count == 2);
  CHECK(sequence.shots[1].connectivity == sequence.shots[0].connectivity);
  REQUIRE(notes.size() == 2);
  CHECK_THAT(notes[0], Contains("f2.obj: attribute \"vt\" begins; a new reference"));
  CHECK_THAT(notes[1], Contains("f4.obj: attribute \"vt\" ends; a new reference"));
}

TEST_CASE("OBJ: the order of the lists is kept where it is asked for and says something") {
  const std::string corners = "f 1/3 2/1 3/2\n";
  const std::string odd = kVertices + "vt 0 0\nvt 1 0\nvt 1 1\n" + corners;
  const std::string plain = kVertices + "vt 1 1\nvt 0 0\nvt 1 0\nf 1/1 2/2 3/3\n";
  const Sequence kept = read_frames({plain, odd}, {.list_order = true});
  const Attribute& index = named(kept.shots[0].attributes, "vt.index");
  CHECK(index.animated);
  CHECK(numbers(index) == std::vector<float>{0, 1, 2, 2, 0, 1});
  CHECK_FALSE(named(kept.shots[0].attributes, "vt").animated);
  CHECK(attribute_named(read_frames({odd}).shots[0].attributes, "vt.index") == nullptr);
  const Sequence needless = read_frames({plain, plain}, {.list_order = true});
  CHECK(attribute_named(needless.shots[0].attributes, "vt.index") == nullptr);
}

TEST_CASE("OBJ: what is read is written back") {
  const std::string text =
      "mtllib a b.mtl\nmtllib c.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
      "v 1 1 0 0 0 1\nvt 0 0\nvt 0.5 0\nvn 0 0 1\no thing\ng x y\nusemtl m\n"
      "s off\nf 1/1/1 2/2/1 3/1/1\nusemtl\nf 1//1 2//1 3//1\n";
  const MeshFrame frame = read_ok(text, MeshFormat::kObj);
  std::vector<std::string> unkept;
  CHECK(write_mesh(frame.connectivity, frame.positions, MeshFormat::kObj, frame.attributes,
                   &unkept) == text);
  CHECK(unkept.empty());
}

TEST_CASE("OBJ: hostile names and indices do no harm to what is written") {
  const TestMesh mesh = plain_mesh();
  Attribute material = make_attribute("usemtl", Semantic::kMaterial, Domain::kFace, ValueType::kI32,
                                      1, std::vector<int32_t>{0, 7});
  material.names = {"a\nf 1 1 1\\"};
  const std::vector<float> uv(12, 0.5f);
  for (const std::vector<int32_t>& index :
       {std::vector<int32_t>{0, 0, 0, 0, 0, 2}, std::vector<int32_t>{0, 0, 0, 0, 0, -1},
        std::vector<int32_t>{0, 0, 0, 0, 0, INT32_MAX}}) {
    const std::vector<Attribute> attributes = {
        material,
        make_attribute("vt", Semantic::kTextureCoordinate, Domain::kCorner, ValueType::kBinary32, 2,
                       uv),
        make_attribute("vt.index", Semantic::kGeneric, Domain::kCorner, ValueType::kI32, 1, index)};
    std::vector<std::string> unkept;
    const MeshFrame back = read_ok(
        write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kObj, attributes, &unkept),
        MeshFormat::kObj);
    CHECK(back.connectivity == mesh.connectivity);
    CHECK(named(back.attributes, "usemtl").names == std::vector<std::string>{"a_f 1 1 1_", "7"});
    CHECK(numbers(back, "vt") == uv);
    CHECK(unkept == std::vector<std::string>{"vt.index"});
  }
}

TEST_CASE("OBJ: a list that no face has at all its corners is said and not kept") {
  const MeshFrame frame = read_ok(kVertices + "vt 0 0\nf 1/1 2 3\nf 1 3/1 4\n", MeshFormat::kObj);
  CHECK(frame.attributes.empty());
  CHECK(frame.unkept ==
        std::vector<Unkept>{{"texture coordinates of faces that have them at some corners only", 2},
                            {"texture coordinates of no corner", 1}});
}

TEST_CASE("PLY: properties that are called like the order of a list stay") {
  const TempFolder folder;
  folder.write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty int a\nproperty int a.index\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n"
               "0 0 0 7 0\n1 0 0 8 1\n0 1 0 9 2\n3 0 1 2\n");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read_sequence({folder / "a.ply"}, {.list_order = true}, sequence, report).ok());
  const std::vector<Attribute>& attributes = sequence.shots[0].attributes;
  CHECK(numbers(named(attributes, "a")) == std::vector<float>{7, 8, 9});
  CHECK(numbers(named(attributes, "a.index")) == std::vector<float>{0, 1, 2});
}

TEST_CASE("OBJ: material texts and the textures that they name are taken along") {
  CHECK(textures_of("newmtl a\nKd 1 1 1\nmap_Kd -s 2 2 2 -clamp on  wood grain.png \nbump -bm 0.5 "
                    "b.png\nmap_aat on\nrefl -type sphere s.jpg\n") ==
        std::vector<std::string>{"wood grain.png", "b.png", "s.jpg"});
  const TempFolder folder;
  folder.write("a.obj", "mtllib my stuff.mtl\nmtllib one.mtl gone.mtl\n" + kVertices);
  folder.write("my stuff.mtl", "newmtl x\nmap_Kd tex/t.png\nmap_Ks tex/t.png\n");
  folder.write("one.mtl", "newmtl y\n");
  folder.write("tex/t.png", std::string("\x89PNG\0", 5));
  Sequence sequence;
  ReadReport report;
  REQUIRE(read_sequence({folder / "a.obj"}, {.embed = true}, sequence, report).ok());
  REQUIRE(sequence.resources.size() == 3);
  CHECK(sequence.resources[0].name == "my stuff.mtl");
  CHECK(sequence.resources[0].media_type == "model/mtl");
  CHECK(sequence.resources[1].name == "tex/t.png");
  CHECK(sequence.resources[1].media_type == "image/png");
  CHECK(sequence.resources[1].bytes == std::vector<uint8_t>{0x89, 'P', 'N', 'G', 0});
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("gone.mtl: cannot be read"));
}

TEST_CASE("OBJ: no file outside of the mesh's folder is taken along, and no hidden one") {
  const TempFolder folder;
  const std::string secret = folder.write("secret.png", "mine");
  folder.write("m/.ssh/key.png", "mine");
  folder.write("m/key", "mine");
  folder.write("m/good.png", "theirs");
  std::filesystem::create_symlink(secret, folder / "m/link.png");
  std::filesystem::create_symlink("good.png", folder / "m/inside.png");
  folder.write("m/a.obj", "mtllib a.mtl\n" + kVertices);
  folder.write("m/a.mtl", "map_Kd ../secret.png\nmap_Kd " + secret +
                              "\nmap_Kd .ssh/key.png\nmap_Kd link.png\nmap_Kd key\n"
                              "map_Kd ./good.png\nmap_Kd inside.png\n");
  Sequence sequence;
  ReadReport report;
  REQUIRE(read_sequence({folder / "m/a.obj"}, {.embed = true}, sequence, report).ok());
  REQUIRE(sequence.resources.size() == 3);
  CHECK(sequence.resources[1].name == "./good.png");
  CHECK(sequence.resources[2].name == "inside.png");
  REQUIRE(report.notes.size() == 5);
  for (const std::string& note : report.notes)
    CHECK_THAT(note, Contains("not embedded") && Contains("copy it there"));
  CHECK_THAT(report.notes[0], Catch::StartsWith("../secret.png"));
}

}  // namespace reeb::tools
