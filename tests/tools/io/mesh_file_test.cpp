#include "tools/io/mesh_file.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/tools/io/read_mesh_text.h"
#include "tests/tools/test_meshes.h"

namespace reeb::tools {
namespace {

using Contains = Catch::Matchers::StdString::ContainsMatcher;
Contains contains(const std::string& text) { return Catch::Contains(text); }

}  // namespace

TEST_CASE("formats are told by the extension in any case") {
  CHECK(mesh_format("a/b.OBJ") == MeshFormat::kObj);
  CHECK(mesh_format("b.ply") == MeshFormat::kPly);
  CHECK(mesh_format("b.Off") == MeshFormat::kOff);
  CHECK(mesh_format("b.stl") == MeshFormat::kStl);
  CHECK_FALSE(mesh_format("b.txt"));
  CHECK_FALSE(mesh_format("obj"));
}

TEST_CASE("odd meshes come through every format with vertices to the bit") {
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff}) {
    for (const TestMesh& mesh : odd_meshes()) {
      INFO(mesh.name << ", format " << static_cast<int>(format));
      const MeshFrame back = read_ok(write_mesh(mesh.connectivity, mesh.positions, format), format);
      CHECK(back.connectivity == mesh.connectivity);
      CHECK(same_bits(back.positions, mesh.positions));
    }
  }
}

TEST_CASE("OBJ: everything around positions and faces is passed over") {
  const std::string text =
      "# comment ending in a backslash \\\r\n"
      "mtllib a.mtl\r\no thing\r\n"
      "v 0 0 0 1.0\r\n"
      "v 1 0 0 0.5 0.25 0.125\r\n"
      "  v\t1 \\\r\n  1 0\r\n"
      "v +0.5e1 -.5 5.\n"
      "vt 0 0\nvn 0 0 1\n\n"
      "g part\nusemtl red\ns 1\n"
      "f 1/1/1 2/1/1 3/1/1\n"
      "f 1//1 -2//1 -1//1 # the last two so far\n"
      "f 1/1 2/1 3/1 \\\n 4/1\n"
      "l 1 2\np 1\n"
      "f 1 2 5\n"
      "v 7 8 9";
  const MeshFrame frame = read_ok(text, MeshFormat::kObj);
  CHECK(same_bits(frame.positions, {0, 0, 0, 1, 0, 0, 1, 1, 0, 5, -0.5f, 5, 7, 8, 9}));
  CHECK(frame.connectivity.face_sizes == Corners{3, 3, 4, 3});
  CHECK(frame.connectivity.corners == Corners{0, 1, 2, 0, 2, 3, 0, 1, 2, 3, 0, 1, 4});
  CHECK(frame.unkept == std::vector<Unkept>{{"lines", 1}, {"points", 1}});
  CHECK(frame.attributes.size() == 10);
}

TEST_CASE("OBJ: a decimal gives the nearest float32, ties to even") {
  // 2^24 + 1 lies half-way between two floats; a hair more rounds up. Rounding first to double
  // would lose the hair of the third number.
  const MeshFrame frame = read_ok(
      "v 16777217 16777217.0000001 16777217.00000000000000000001\n"
      "v 1e-46 -1e-60 7.1e-46\n",
      MeshFormat::kObj);
  CHECK(same_bits(frame.positions, {16777216, 16777218, 16777218, 0, -0.0f, 1e-45f}));
}

TEST_CASE("OBJ: bad files say what is wrong and where") {
  CHECK_THAT(failure("", MeshFormat::kObj), contains("no vertices"));
  CHECK_THAT(failure("# nothing\n", MeshFormat::kObj), contains("no vertices"));
  CHECK_THAT(failure("\x7f"
                     "ELF garbage",
                     MeshFormat::kObj),
             contains("line 1: '?ELF' is not a statement of OBJ"));
  CHECK_THAT(failure("v 0 0 0\nv 1 2\n", MeshFormat::kObj), contains("line 2"));
  CHECK_THAT(failure("v 0 0 zero\n", MeshFormat::kObj), contains("line 1"));
  CHECK_THAT(failure("v 0 0 0\nf 0 1 1\n", MeshFormat::kObj), contains("line 2"));
  CHECK_THAT(failure("v 0 0 0\nf -2 1 1\n", MeshFormat::kObj), contains("line 2"));
  CHECK_THAT(failure("v 0 0 0\nf 1 a 1\n", MeshFormat::kObj), contains("line 2"));
  CHECK_THAT(failure("v 0 0 0\nf \n", MeshFormat::kObj), contains("line 2"));
  CHECK_THAT(failure("v 0 0 0\nf 1 1 1\nf 1 1 99999\n", MeshFormat::kObj),
             contains("face 2 uses vertex 99,999 of 1"));
  for (const char* bad : {"nan", "inf", "-inf", "1e39", "1e400"}) {
    INFO(bad);
    CHECK_THAT(failure("v 0 0 0\nv 0 " + std::string(bad) + " 0\n", MeshFormat::kObj),
               contains("coordinate y of vertex 2 is not a finite"));
  }
}

TEST_CASE("OBJ: equal connectivity is recognised by its text or by its numbers") {
  const std::string first = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const MeshFrame frame = read_ok(first, MeshFormat::kObj);
  CHECK(std::string(frame.face_text) == "f 1 2 3\n");
  const MeshReference reference{frame.connectivity, std::string(frame.face_text)};

  const MeshFrame same =
      read_ok("v 0 0 5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshFormat::kObj, &reference);
  CHECK(same.same_connectivity);
  CHECK(same.positions[2] == 5);
  CHECK(read_ok("v 0 0 5\nv 1 0 0\nv 0 1 0\nf -3 -2 -1", MeshFormat::kObj, &reference)
            .same_connectivity);

  const MeshFrame more =
      read_ok("v 0 0 5\nv 1 0 0\nv 0 1 0\nv 3 3 3\nf 1 2 3\n", MeshFormat::kObj, &reference);
  CHECK_FALSE(more.same_connectivity);
  CHECK(more.connectivity.vertex_count == 4);
  const MeshFrame turned =
      read_ok("v 0 0 5\nv 1 0 0\nv 0 1 0\nf 2 3 1\n", MeshFormat::kObj, &reference);
  CHECK_FALSE(turned.same_connectivity);
  CHECK(turned.connectivity.corners == Corners{1, 2, 0});
}

TEST_CASE("OBJ: vertices behind faces rule the comparison of texts out") {
  const std::string first = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\nv 4 4 4\n";
  CHECK(read_ok(first, MeshFormat::kObj).face_text.empty());
}

TEST_CASE("PLY: ascii and both binary orders, any type, other elements and properties skipped") {
  const auto header = [](const std::string& format) {
    return "ply\nformat " + format +
           " 1.0\ncomment made by hand\nelement camera 1\nproperty list uchar short view\n"
           "element vertex 3\nproperty uchar red\nproperty double x\nproperty short y\n"
           "property float z\nproperty list uchar uchar tags\n"
           "element face 2\nproperty list uint uint vertex_index\nproperty uchar "
           "flag\nend_header\n";
  };
  const std::vector<float> positions{0.1f, -2, 0.5f, 1, 300, -0.0f, 2, 4, 1e-3f};
  const std::string ascii = header("ascii") +
                            "2 7 8\n9 0.1 -2 0.5 0\n9 1 300 -0 2 5 6\n9 2 4 1e-3 1 4\n"
                            "3 0 1 2 1\n4 2 1 0 2 0\n";

  const auto binary = [&](bool big) {
    std::string out;
    const auto put = [&](auto value) {
      std::string bytes(sizeof value, '\0');
      std::memcpy(bytes.data(), &value, sizeof value);
      const bool reverse = big == (std::endian::native == std::endian::little);
      out += reverse ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
    };
    put(uint8_t{2}), put(int16_t{7}), put(int16_t{8});
    const std::vector<std::vector<uint8_t>> tags{{}, {5, 6}, {4}};
    const double x[3] = {0.1, 1, 2};
    for (size_t v = 0; v < 3; ++v) {
      put(uint8_t{9}), put(x[v]), put(static_cast<int16_t>(positions[3 * v + 1]));
      put(positions[3 * v + 2]), put(static_cast<uint8_t>(tags[v].size()));
      for (const uint8_t tag : tags[v]) put(tag);
    }
    put(uint32_t{3}), put(uint32_t{0}), put(uint32_t{1}), put(uint32_t{2}), put(uint8_t{1});
    put(uint32_t{4});
    for (const uint32_t v : {2u, 1u, 0u, 2u}) put(v);
    put(uint8_t{0});
    return header(big ? "binary_big_endian" : "binary_little_endian") + out;
  };

  for (const std::string& bytes : {ascii, binary(false), binary(true)}) {
    const MeshFrame frame = read_ok(bytes, MeshFormat::kPly);
    CHECK(same_bits(frame.positions, positions));
    CHECK(frame.connectivity.face_sizes == Corners{3, 4});
    CHECK(frame.connectivity.corners == Corners{0, 1, 2, 2, 1, 0, 2});
    CHECK(frame.unkept == std::vector<Unkept>{{"camera", 1}, {"list tags", 3}});
    REQUIRE(frame.attributes.size() == 2);
    CHECK(frame.attributes[0].name == "red");
    CHECK(frame.attributes[0].values == std::vector<uint8_t>{9, 9, 9});
    CHECK(frame.attributes[1].name == "flag");
    CHECK(frame.attributes[1].domain == Domain::kFace);
    CHECK(frame.attributes[1].values == std::vector<uint8_t>{1, 0});
  }
}

TEST_CASE("PLY: every cut of a file is an error") {
  const TestMesh mesh = plain_mesh();
  const std::string whole = write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kPly);
  for (size_t size = 0; size < whole.size(); ++size) {
    INFO(size);
    failure(whole.substr(0, size), MeshFormat::kPly);
  }
}

TEST_CASE("PLY: announced counts beyond the file fail before memory is taken") {
  const std::string vertices =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n" +
      std::string(120, '\0');
  CHECK_THAT(failure(vertices, MeshFormat::kPly), contains("vertex list"));
  const std::string faces =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 18446744073709551615\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 0\n";
  CHECK_THAT(failure(faces, MeshFormat::kPly), contains("face list"));
  // A list of four thousand million corners in a file of a few bytes.
  const std::string corners =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n" +
      std::string(12, '\0') + "\xff\xff\xff\xff" + std::string(8, '\0');
  CHECK_THAT(failure(corners, MeshFormat::kPly), contains("face list"));
}

TEST_CASE("PLY: bad headers and unsupported content") {
  CHECK_THAT(failure("solid", MeshFormat::kPly), contains("must begin with ply"));
  CHECK_THAT(failure("ply\nformat odd 1.0\nend_header\n", MeshFormat::kPly), contains("line 2"));
  CHECK_THAT(failure("ply\nproperty float x\nend_header\n", MeshFormat::kPly), contains("line 2"));
  CHECK_THAT(failure("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty half h\n"
                     "end_header\n0\n",
                     MeshFormat::kPly),
             contains("line 4: property 'h' has the unknown type 'half'"));
  CHECK_THAT(failure("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
                     MeshFormat::kPly),
             contains("no x, y and z"));
  CHECK_THAT(failure("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                     "property float z\nend_header\n",
                     MeshFormat::kPly),
             contains("no vertices"));
  CHECK_THAT(failure("ply\nformat ascii 1.0\nelement tristrips 1\n"
                     "property list int int vertex_indices\nend_header\n1 0\n",
                     MeshFormat::kPly),
             contains("strips"));
}

TEST_CASE("OFF: comments, colours and header variants") {
  const MeshFrame frame = read_ok(
      "COFF # colours follow\n# counts\n4 2 0\n\n0 0 0 255 0 0 255\n1 0 0\n# between\n1 1 0\n0 1 "
      ".5\n"
      "3 0 1 2 0.5 0.5 0.5\n4 0 1 2 3\n",
      MeshFormat::kOff);
  CHECK(same_bits(frame.positions, square()));
  CHECK(frame.connectivity.face_sizes == Corners{3, 4});
  CHECK(frame.connectivity.corners == Corners{0, 1, 2, 0, 1, 2, 3});
  CHECK(read_ok("OFF 1 0 0\n1 2 3", MeshFormat::kOff).positions == std::vector<float>{1, 2, 3});
}

TEST_CASE("OFF: bad files") {
  CHECK_THAT(failure("4OFF\n1 0 0\n1 2 3 4\n", MeshFormat::kOff), contains("OFF"));
  CHECK_THAT(failure("OFF BINARY\n", MeshFormat::kOff), contains("binary"));
  CHECK_THAT(failure("OFF\n", MeshFormat::kOff), contains("the count of vertices"));
  CHECK_THAT(failure("OFF\n3000000000 0 0\n0 0 0\n", MeshFormat::kOff), contains("truncated"));
  CHECK_THAT(failure("OFF\n1 3000000000 0\n0 0 0\n", MeshFormat::kOff), contains("truncated"));
  CHECK_THAT(failure("OFF\n2 0 0\n0 0 0\n1 x 0\n", MeshFormat::kOff), contains("line 4"));
  CHECK_THAT(failure("OFF\n1 1 0\n0 0 0\n3 0 0\n", MeshFormat::kOff), contains("line 4"));
  CHECK_THAT(failure("OFF\n1 1 0\n0 0 0\n3 0 0 1\n", MeshFormat::kOff), contains("vertex 2 of 1"));
  CHECK_THAT(failure("OFF\n0 0 0\n", MeshFormat::kOff), contains("no vertices"));
}

TEST_CASE("STL: corners at equal positions are one vertex, in order of appearance") {
  const std::string ascii =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
      "endfacet\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 1 1 0\nvertex 0 1 0.5\n"
      "endloop\nendfacet\nendsolid a\n";
  const TestMesh mesh = plain_mesh();
  const std::string binary = write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kStl);
  CHECK(binary.size() == 84 + 2 * 50);
  std::string binary_solid = binary;
  binary_solid.replace(0, 5, "solid");
  for (const std::string& bytes : {ascii, binary, binary_solid}) {
    const MeshFrame frame = read_ok(bytes, MeshFormat::kStl);
    CHECK(frame.connectivity == mesh.connectivity);
    CHECK(same_bits(frame.positions, mesh.positions));
  }
}

TEST_CASE("STL: vertices of the reference may meet for a frame, but not split") {
  const TestMesh mesh = plain_mesh();
  const MeshReference reference{mesh.connectivity, ""};
  std::vector<float> meeting = mesh.positions;
  std::copy_n(&meeting[0], 3, &meeting[9]);
  const MeshFrame frame = read_ok(write_mesh(mesh.connectivity, meeting, MeshFormat::kStl),
                                  MeshFormat::kStl, &reference);
  CHECK(frame.same_connectivity);
  CHECK(same_bits(frame.positions, meeting));

  const TestMesh apart = test_mesh("apart", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 1, 1, 0, 1, 1},
                                   {{0, 1, 2}, {3, 4, 5}});
  const MeshFrame split = read_ok(write_mesh(apart.connectivity, apart.positions, MeshFormat::kStl),
                                  MeshFormat::kStl, &reference);
  CHECK_FALSE(split.same_connectivity);
  CHECK(split.connectivity == apart.connectivity);
}

TEST_CASE("STL: polygons are written as fans") {
  const TestMesh mesh = test_mesh("quad", square(), {{0, 1, 2, 3}});
  const MeshFrame frame =
      read_ok(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kStl), MeshFormat::kStl);
  CHECK(frame.connectivity == plain_mesh().connectivity);
}

TEST_CASE("STL: bad files") {
  const TestMesh mesh = plain_mesh();
  const std::string binary = write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kStl);
  CHECK_THAT(failure(binary.substr(0, binary.size() - 1), MeshFormat::kStl), contains("truncated"));
  CHECK_THAT(failure("nothing", MeshFormat::kStl), contains("STL"));
  CHECK_THAT(failure("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", MeshFormat::kStl),
             contains("endsolid"));
  CHECK_THAT(failure("solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\n", MeshFormat::kStl),
             contains("triangle"));
  CHECK_THAT(failure("solid a\nendsolid a\n", MeshFormat::kStl), contains("no vertices"));
}

TEST_CASE("damaged bytes give an error or a sound mesh") {
  const TestMesh mesh = odd_meshes()[7];
  std::mt19937 random(1);
  int sound = 0;
  for (const MeshFormat format :
       {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff, MeshFormat::kStl}) {
    const std::string whole = write_mesh(mesh.connectivity, mesh.positions, format);
    for (int round = 0; round < 3000; ++round) {
      std::string bytes = whole;
      for (uint32_t i = random() % 4; i < 4; ++i) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      if (random() % 4 == 0) bytes.resize(random() % bytes.size());
      MeshFrame out;
      const Status status = read_mesh(bytes, format, nullptr, out);
      if (!status.ok()) continue;
      ++sound;
      const auto& c = out.connectivity;
      bool good = out.positions.size() == size_t{3} * c.vertex_count;
      size_t corners = 0;
      for (const uint32_t size : c.face_sizes) {
        good = good && size > 0;
        corners += size;
      }
      good = good && corners == c.corners.size();
      for (const uint32_t v : c.corners) good = good && v < c.vertex_count;
      for (const float x : out.positions) good = good && std::isfinite(x);
      if (!good) FAIL("format " << static_cast<int>(format) << ", round " << round);
    }
  }
  CHECK(sound > 1000);
}

TEST_CASE("written text is short and plain") {
  const TestMesh mesh = test_mesh("m", {0.1f, -2, 1e-10f}, {{0}});
  CHECK(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kObj) == "v 0.1 -2 1e-10\nf 1\n");
  CHECK(write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kOff) ==
        "OFF\n1 1 0\n0.1 -2 1e-10\n1 0\n");
}

}  // namespace reeb::tools
