#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"
#include "tests/tools/temp_folder.h"
#include "tests/tools/test_meshes.h"
#include "tools/attribute_metrics.h"
#include "tools/command.h"
#include "tools/io/attribute_values.h"
#include "tools/picture/attribute_paint.h"
#include "tools/picture/contact_sheet.h"
#include "tools/picture/read_image.h"

namespace reeb::tools {
namespace {

using Catch::Contains;
using json = nlohmann::json;

/// Two frames of a square in two materials, whose texture moves.
const std::string kFirst =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
    "usemtl red\nf 1/1/1 2/2/1 3/3/1\nusemtl blue\nf 1/1/1 3/3/1 4/2/1\nl 1 2\n";

struct Frames {
  TempFolder folder;
  std::string frames, stream;
  Frames() : frames(folder / "in"), stream(folder / "a.reeb") {
    folder.write("in/f_1.obj", kFirst);
    std::string second = kFirst;
    second.replace(second.find("vt 1 1"), 6, "vt 1 2");
    folder.write("in/f_2.obj", second);
  }
  CommandResult encode(std::vector<std::string> options) const {
    options.insert(options.begin(), {"encode", frames, "-o", stream, "-f"});
    return run_reeb(options);
  }
};

Sequence square(const std::vector<Attribute>& attributes,
                const std::vector<std::vector<uint32_t>>& faces = {{0, 1, 2}, {0, 2, 3}}) {
  const TestMesh mesh = test_mesh("square", tools::square(), faces);
  Sequence out;
  out.shots.push_back({mesh.connectivity, 2, mesh.positions, attributes});
  auto& positions = out.shots[0].positions;
  positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
  return out;
}

template <class T>
Attribute of_faces(const std::string& name, ValueType type, const std::vector<T>& values) {
  return make_attribute(name, Semantic::kGroup, Domain::kFace, type, 1, values);
}

}  // namespace

TEST_CASE("info tells attributes", "[attributes]") {
  const Frames f;
  const CommandResult encoded = f.encode({"--lossless"});
  REQUIRE(encoded.exit_code == kExitDone);
  CHECK_THAT(encoded.err, Contains("f_1.obj: not kept: lines (1)") && Contains("attributes: vt ") &&
                              Contains("usemtl "));
  const json told = json::parse(run_reeb({"info", f.stream, "--json"}).out);
  REQUIRE(told["attributes"].size() == 4);
  json vt = told["attributes"][0];
  CHECK(vt["bytes"].get<int>() > 0);
  vt.erase("bytes");
  CHECK(vt == json{{"shot", 1},
                   {"name", "vt"},
                   {"semantic", "texture coordinate"},
                   {"domain", "corner"},
                   {"type", "float32"},
                   {"channels", 2},
                   {"time", "animated"}});
  CHECK(told["attributes"][1]["time"] == "static");
  CHECK(told["attributes"][2]["semantic"] == "material");
  CHECK_THAT(run_reeb({"info", f.stream}).out,
             Contains("4 attributes\n  vt: texture coordinate of each corner, 2 x float32, "
                      "animated, ") &&
                 Contains("  mtllib: group of each shot"));
}

TEST_CASE("compare holds attributes against tolerances of their own", "[attributes]") {
  const Frames f;
  REQUIRE(f.encode({"--lossless", "--attribute", "vt=error:0.25", "--attribute", "mtllib=drop"})
              .exit_code == kExitDone);
  const auto compare = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"compare", f.frames, f.stream});
    return run_reeb(options);
  };
  const CommandResult plain = compare({});
  CHECK(plain.exit_code == kExitDone);
  CHECK_THAT(plain.out, Contains("attribute vt: maximum error ") &&
                            Contains("attribute usemtl: identical") &&
                            Contains("attribute mtllib: only in the original"));
  CHECK(compare({"--attribute", "vt=0.2500001", "--attribute", "us*=0"}).exit_code == kExitDone);
  const CommandResult over = compare({"--attribute", "v?=0.0001"});
  CHECK(over.exit_code == kExitOverTolerance);
  CHECK_THAT(over.err, Contains("attribute vt is over 0.0001: 0."));
  const CommandResult gone = compare({"--attribute", "mtllib=1"});
  CHECK(gone.exit_code == kExitOverTolerance);
  CHECK_THAT(gone.err, Contains("only in the original"));
  CHECK(compare({"--attribute", "vt"}).exit_code == kExitUsage);
  const json told = json::parse(compare({"--json"}).out);
  CHECK(told["attributes"][0]["name"] == "vt");
  CHECK(told["attributes"][0]["max_error"].size() == 2);
}

TEST_CASE("attributes are compared by name, whatever the order of faces and tables",
          "[attributes]") {
  Attribute material = of_faces<int32_t>("m", ValueType::kI32, {0, 1});
  material.names = {"red", "blue"};
  Attribute other = of_faces<int32_t>("m", ValueType::kI32, {0, 1});
  other.names = {"blue", "red"};
  const auto corner = [](const std::vector<float>& values) {
    return make_attribute("c", Semantic::kGeneric, Domain::kCorner, ValueType::kBinary32, 1,
                          values);
  };
  const Sequence a = square({material, corner({0, 1, 2, 3, 4, 5})});
  // The second face first, and both from another corner on.
  const Sequence b = square({other, corner({4, 5, 3, 1, 2, 0.5f})}, {{2, 3, 0}, {1, 2, 0}});
  const auto found = compare_attributes(a, b);
  REQUIRE(found.size() == 2);
  CHECK(found[0].identical);
  CHECK(found[0].compared == 2);
  CHECK(found[1].max_error == std::vector<double>{0.5});
  CHECK(found[1].different == 1);
}

TEST_CASE("normals are compared by their angle, ids by how many differ", "[attributes]") {
  const auto normals = [](float x, float z) {
    return make_attribute("n", Semantic::kNormal, Domain::kVertex, ValueType::kBinary32, 3,
                          std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, x, 0, z});
  };
  Attribute moving = of_faces<uint8_t>("id", ValueType::kU8, {1, 2, 1, 9});
  moving.animated = true;
  const Sequence a = square({normals(0, 1), of_faces<uint8_t>("id", ValueType::kU8, {1, 2})});
  const Sequence b = square({normals(2, 2), moving});
  const auto found = compare_attributes(a, b);
  REQUIRE(found.size() == 2);
  CHECK(found[0].figure() == Approx(45));
  CHECK(found[1].compared == 4);
  CHECK(found[1].figure() == 1);
  CHECK(compare_attributes(a, square({normals(0, 1)}))[1].figure() == INFINITY);
}

TEST_CASE("pictures show attributes and textures", "[attributes]") {
  const Camera front = Camera::orbit(0, 0, false);
  Sequence a = square(
      {of_faces<int32_t>("id", ValueType::kI32, {0, 1}),
       make_attribute("heat", Semantic::kGeneric, Domain::kVertex, ValueType::kBinary32, 1,
                      std::vector<float>{-1, 0, 3, 1}),
       make_attribute("vt", Semantic::kTextureCoordinate, Domain::kCorner, ValueType::kBinary32, 2,
                      std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1})});
  ColourScale scale;
  REQUIRE(find_scale(a, "heat", scale).ok());
  CHECK(scale.low == -1);
  CHECK(scale.high == 3);
  const auto heat = paint_corners(a.shots[0], 1, "heat", scale);
  REQUIRE(heat.size() == 6);
  CHECK(heat[0] == error_colour(0));
  CHECK(heat[2] == error_colour(1));
  CHECK(heat[5] == error_colour(0.5));
  const auto id = paint_corners(a.shots[0], 0, "id", scale);
  CHECK(id[0] == id[2]);
  CHECK(id[2] != id[3]);
  CHECK_THAT(find_scale(a, "gone", scale).message(), Contains("there are id, heat, vt"));

  // The left half of the texture is red, the upper right quarter green.
  Image texture(2, 2, {255, 0, 0});
  texture.at(1, 0) = {0, 255, 0};
  texture.at(1, 1) = {0, 0, 255};
  std::string png;
  REQUIRE(encode_png(texture, png).ok());
  Image read(1, 1);
  REQUIRE(decode_image(png, read).ok());
  CHECK(read.pixels == texture.pixels);
  CHECK_FALSE(decode_image(png.substr(0, 40), read).ok());
  CHECK_FALSE(decode_image("no picture", read).ok());
  const auto places = texture_coordinates(a.shots[0], 0);
  Image image(40, 40);
  const Colour grey{9, 9, 9};
  const Shot& shot = a.shots[0];
  draw_painted(shot.connectivity, shot.frame(0), {{&grey, 1}, &texture, places}, front,
               {{0.5, 0.5, 0}, 40}, image);
  const auto strongest = [&](int x, int y) {
    const Colour& c = image.at(x, y);
    return std::max_element(c.begin(), c.end()) - c.begin();
  };
  CHECK(strongest(10, 10) == 0);
  CHECK(strongest(10, 30) == 0);
  CHECK(strongest(30, 10) == 1);
  CHECK(strongest(30, 30) == 2);

  const Frames f;
  const std::string sheet = f.folder / "sheet.png";
  const CommandResult missing = run_reeb({"picture", f.frames, "-o", sheet, "--attribute", "x"});
  CHECK(missing.exit_code == kExitFailed);
  CHECK_THAT(missing.err, Contains("there are vt, vn, usemtl, mtllib"));
  f.folder.write("t.png", png);
  CHECK(run_reeb({"picture", f.frames, "-o", sheet, "--texture", f.folder / "t.png"}).exit_code ==
        kExitDone);
}

TEST_CASE("what a format has no place for is said", "[attributes]") {
  const Frames f;
  REQUIRE(f.encode({"--lossless"}).exit_code == kExitDone);
  const auto decode = [&](const std::string& name) {
    const CommandResult r = run_reeb({"decode", f.stream, "-o", f.folder / name});
    CHECK(r.exit_code == kExitDone);
    return r.err;
  };
  CHECK_THAT(decode("a_%d.stl"),
             Contains("not written, for which the format has no place: mtllib, usemtl, vn, vt"));
  CHECK_THAT(decode("a_%d.ply"), Contains("no place: mtllib, names of usemtl"));
  CHECK_THAT(decode("a.pc2"), Contains("changes over time") && Contains(": vt"));
  CHECK_THAT(decode("a_%d.obj"), !Contains("place"));
}

}  // namespace reeb::tools
