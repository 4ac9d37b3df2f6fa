// What other programs write: each spelling is either read for what it means or refused with a word.
#include <catch2/catch.hpp>
#include <chrono>

#include "tests/tools/io/read_mesh_text.h"
#include "tests/tools/test_meshes.h"

namespace reeb::tools {
namespace {

using Catch::Contains;

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid x\n";
const std::string kPlyVertices =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyRows = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
const std::string kPly = "ply\nformat ascii 1.0\n" + kPlyVertices +
                         "element face 1\nproperty list uchar int vertex_indices\n" + kPlyRows +
                         "3 0 1 2\n";

struct Spelling {
  MeshFormat format;
  std::string bytes;
};
std::vector<Spelling> one_triangle() {
  return {{MeshFormat::kObj, kObj},
          {MeshFormat::kOff, kOff},
          {MeshFormat::kStl, kStl},
          {MeshFormat::kPly, kPly}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

MeshFrame check_triangle(const std::string& bytes, MeshFormat format) {
  INFO(bytes);
  MeshFrame frame = read_ok(bytes, format);
  CHECK(frame.positions == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  CHECK(frame.connectivity.face_sizes == Corners{3});
  CHECK(frame.connectivity.corners == Corners{0, 1, 2});
  return frame;
}

std::string with_name(const MeshFrame& frame) {
  std::string out;
  for (const Unkept& u : frame.unkept) out += u.name + " " + std::to_string(u.count) + "; ";
  return out;
}

}  // namespace

TEST_CASE("any ends of lines and a byte-order mark are read in every text") {
  for (const auto& [format, text] : one_triangle()) {
    for (const char* end : {"\n", "\r", "\r\n", "\n\r", "\r\r\n", " \t\n"}) {
      if (format == MeshFormat::kPly && end == std::string("\r\r\n")) continue;
      check_triangle(replaced(text, "\n", end), format);
      check_triangle("\xef\xbb\xbf" + replaced(text, "\n", end), format);
    }
    std::string mixed = text;
    mixed.replace(mixed.find('\n'), 1, "\r\n");
    check_triangle(mixed, format);
    if (format != MeshFormat::kPly) check_triangle(text + "\x1a", format);
    std::string utf16 = "\xff\xfe";
    for (const char c : text) utf16 += {c, '\0'};
    CHECK_THAT(failure(utf16, format), Contains("UTF-16"));
  }
}

TEST_CASE("a coordinate that is no number is refused where it stands") {
  for (const auto& [format, text] : one_triangle()) {
    for (const char* bad :
         {"0,5", "-1.#IND00", "1.#QNAN", "2.5+3", "1.5D+02x", "0x1", "1.0.0", "zero"}) {
      const std::string broken = replaced(text, "1 0 0", std::string("1 0 ") + bad);
      INFO(broken);
      const std::string line =
          "line " + std::to_string(
                        1 + std::count(broken.begin(),
                                       broken.begin() + static_cast<long>(broken.find(bad)), '\n'));
      CHECK_THAT(failure(broken, format), Contains(line + ": '" + bad + "' is not"));
    }
    const MeshFrame fortran = read_ok(replaced(text, "1 0 0", "1 0 1.5D+02"), format);
    CHECK(fortran.positions[5] == 150);
  }
}

TEST_CASE("the remedy fits the number") {
  CHECK_THAT(failure("v 0 0 0,5\n", MeshFormat::kObj), Contains("need a decimal point"));
  CHECK_THAT(failure("v 0 0 1.#INF\n", MeshFormat::kObj), Contains("not finite; repair the frame"));
  CHECK_THAT(failure("v 0 0 zero\n", MeshFormat::kObj), Contains("export it again"));
}

TEST_CASE("what follows the last element is refused or told") {
  CHECK_THAT(failure(kOff + "3 0 1 2\n", MeshFormat::kOff), Contains("line 7: more follows"));
  CHECK_THAT(failure(kPly + "3 0 1 2\n", MeshFormat::kPly), Contains("line 14: '3' is not"));
  CHECK_THAT(failure(kStl + "vertex 0 0 0\n", MeshFormat::kStl),
             Contains("line 10: 'vertex' is not"));
  CHECK_THAT(failure(kObj + "1 2 3\n", MeshFormat::kObj), Contains("line 5: '1' is not"));
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kStl}) {
    const TestMesh mesh = plain_mesh();
    const MeshFrame frame =
        read_ok(write_mesh(mesh.connectivity, mesh.positions, format) + "12 bytes..\n.", format);
    CHECK(frame.connectivity == mesh.connectivity);
    REQUIRE(frame.notes.size() == 1);
    CHECK_THAT(frame.notes[0], Contains("12 bytes behind"));
  }
}

TEST_CASE("OBJ: lines continue anywhere") {
  for (const char* text : {"v 0 0 0\nv 1 \\\n0 0\nv 0 1\\\n 0\nf 1 2\\\n3\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1\\\n 3/1\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\ \n3\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 \\\n0\ng a \\\nb\nf \\\n1 2 3 \\\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\ncurv 0 1 \\\r\n1 2\r\nf 1 2 3\r\n",
                           "v\\\n0 0 0\nv\\ \n 1 0 0\nv 0 1 0\nvt\\\r\n1\nf\\\r1 2 3\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\ng\\\na\\\nb\nl\\\n1 2\nfo\\\n1 2 3\n"}) {
    check_triangle(text, MeshFormat::kObj);
  }
  CHECK_THAT(failure("v 0 0 0\nf 1 \\1 1\n", MeshFormat::kObj), Contains("line 2"));
  CHECK_THAT(failure("v 0 0 0\nf\\1 1 1\n", MeshFormat::kObj), Contains("line 2"));
}

TEST_CASE("OBJ: a keyword alone is a statement of which everything is missing") {
  for (const char* end : {"\n", "\r", "", " \n"}) {
    INFO(end);
    CHECK_THAT(failure(std::string("v 0 0 0\nv") + end, MeshFormat::kObj),
               Contains("line 2") && Contains("coordinates of a vertex"));
    CHECK_THAT(failure(std::string("v 0 0 0\nf") + end, MeshFormat::kObj),
               Contains("line 2") && Contains("a face without vertices"));
    CHECK_THAT(failure(std::string("v 0 0 0\nvt") + end, MeshFormat::kObj), Contains("line 2"));
    CHECK_THAT(failure(std::string("v 0 0 0\nvn") + end, MeshFormat::kObj), Contains("line 2"));
  }
}

TEST_CASE("OBJ: corners are what they may be") {
  for (const char* corner : {"1", "1/1", "1//1", "1/1/1", "1/", "1//", "1/-1/-1", "+1"}) {
    check_triangle(replaced(kObj, "f 1 ", std::string("f ") + corner + " "), MeshFormat::kObj);
  }
  for (const char* corner :
       {"1/a", "1/1/1/1", "1/1/b", "1.0", "/1", "1,", "1\\1", "99999999999999999999"}) {
    INFO(corner);
    CHECK_THAT(failure(replaced(kObj, "f 1 ", std::string("f ") + corner + " "), MeshFormat::kObj),
               Contains("line 4: '") && Contains("' is not a vertex of a face"));
  }
}

TEST_CASE("OBJ: what is not kept is counted") {
  CHECK(with_name(read_ok("v 0 0 0 1 0 0\nv 1 0 0 0 1 0 1\nv 0 1 0 1\nv 0 1 0 2\nl 1 2\np 1\n",
                          MeshFormat::kObj)) == "lines 1; points 1; ");
  CHECK(with_name(read_ok(kObj + "cstype bezier\ndeg 2\ncurv 0 1 1 2 3\nend\n",
                          MeshFormat::kObj)) == "curves and surfaces 4; ");
  CHECK(with_name(read_ok(kObj + "xfoo 1\nxfoo 2\n", MeshFormat::kObj)) == "statements 'xfoo' 2; ");
  check_triangle(replaced(kObj, "f ", "fo "), MeshFormat::kObj);
  CHECK_THAT(failure("v 1 2 3 4 5\n", MeshFormat::kObj), Contains("a vertex of 5 numbers"));
  CHECK_THAT(failure("v 1 2 3 4 5 6 7 8\n", MeshFormat::kObj), Contains("a vertex of 8 numbers"));
  CHECK_THAT(failure("v 1 2 3 red\n", MeshFormat::kObj), Contains("'red' is not"));
  std::string prose;
  for (char c = 'a'; c <= 'z'; ++c) prose += std::string(3, c) + " and more\n";
  CHECK_THAT(failure(prose, MeshFormat::kObj),
             Contains("line 17: 'qqq' is not a statement of OBJ"));
}

TEST_CASE("OFF: the words may stand on any lines, and the keyword may be missing or glued") {
  for (const char* text :
       {"OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF\n3\n1\n0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF 3 1 0\n0 0 0 1 0 0 0 1 0\n3 0 1 2\n",
        "OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF 3 1\n0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2", "off 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2",
        "OFF\n# c\n3 1 0 # d\n\n0 0\n0 1 0 0 0\n1\n0\n3 0\n1 2\n",
        "OFF 3 1 0\n0 0 0 # a\n1 0 0\n# b\n0 1 0\n\n3 0 1 2 # c\n# d\n"}) {
    CHECK(check_triangle(text, MeshFormat::kOff).unkept.empty());
  }
}

TEST_CASE("OFF: what is not kept is counted") {
  CHECK(with_name(check_triangle("COFF\n3 1 0\n0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1\n3 0 1 2 9\n",
                                 MeshFormat::kOff)) ==
        "numbers behind the coordinates 3; numbers behind the vertices of faces 1; ");
  CHECK(with_name(check_triangle("OFF\n3 1 0\n0 0 0 7\n1 0 0 7\n0 1 0\n3 0 1 2\n",
                                 MeshFormat::kOff)) == "numbers behind the coordinates 2; ");
  CHECK_THAT(failure("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0\n", MeshFormat::kOff),
             Contains("line 6: a face without vertices"));
  CHECK_THAT(failure("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 red\n", MeshFormat::kOff),
             Contains("'red' is not"));
  CHECK_THAT(failure("OFFX\n3 1 0\n", MeshFormat::kOff), Contains("must begin with OFF"));
  CHECK_THAT(failure("OFF\n3 x 0\n", MeshFormat::kOff), Contains("'x' is not the count of faces"));
}

TEST_CASE("STL: keywords in any case, ends in one word or two, blank lines") {
  std::string upper;
  for (const char c : kStl) upper += static_cast<char>(std::toupper(c));
  for (const std::string& text :
       {upper, replaced(kStl, "solid x", "Solid Unity Mesh"),
        replaced(kStl, "endsolid", "end solid"), replaced(kStl, "endloop", "end loop"),
        replaced(kStl, "endfacet", "End Facet"), "\n\n  " + kStl, replaced(kStl, "\n", "\n\n"),
        replaced(kStl, "0 0 1", "nan nan -1.#IND"), replaced(kStl, " normal 0 0 1", ""),
        replaced(kStl, "\nvertex", " vertex"), kStl + "\n \n"}) {
    CHECK(check_triangle(text, MeshFormat::kStl).unkept.empty());
  }
  CHECK(with_name(read_ok(kStl + kStl, MeshFormat::kStl)) == "solids 2; ");
  const MeshFrame padded = check_triangle(kStl + std::string(3, '\0'), MeshFormat::kStl);
  CHECK(padded.notes == std::vector<std::string>{"3 zero bytes behind the text ignored"});
  CHECK_THAT(failure(replaced(kStl, "endloop", "vertex 0 0 0\nendloop"), MeshFormat::kStl),
             Contains("line 7: 'vertex' is not 'endloop'"));
  CHECK_THAT(failure(replaced(kStl, "facet normal", "facette normal"), MeshFormat::kStl),
             Contains("line 2: 'facette' is not"));
}

TEST_CASE("STL: binary files of any size say what is wrong with it") {
  const TestMesh mesh = plain_mesh();
  std::string binary = write_mesh(mesh.connectivity, mesh.positions, MeshFormat::kStl);
  binary.replace(0, 5, "solid");
  CHECK(read_ok(binary + "xy", MeshFormat::kStl).connectivity == mesh.connectivity);
  CHECK_THAT(failure(binary.substr(0, 133), MeshFormat::kStl),
             Contains("announces 2 triangles, holds 0"));
  binary[binary.size() - 1] = 1;
  CHECK(with_name(read_ok(binary, MeshFormat::kStl)) == "attribute bytes 1; ");
}

TEST_CASE("STL: corners that are no numbers, or chosen to be slow, are no work") {
  std::string binary(84, '\0');
  constexpr uint32_t kTriangles = 30000;
  for (int i = 0; i < 4; ++i) binary[80 + i] = static_cast<char>(kTriangles >> (8 * i));
  const auto filled = [&](char fill) { return binary + std::string(50 * kTriangles, fill); };
  const auto start = std::chrono::steady_clock::now();
  CHECK_THAT(failure(filled('\xff'), MeshFormat::kStl),
             Contains("triangle 1 has a coordinate that is not a finite"));
  CHECK(read_ok(filled('\1'), MeshFormat::kStl).connectivity.vertex_count == 1);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("PLY: headers that other programs write") {
  const auto header = [](const std::string& element) {
    return "ply\nformat ascii 1.0\n" + kPlyVertices + element + kPlyRows;
  };
  CHECK(read_ok(header("element face 0\n"), MeshFormat::kPly).connectivity.vertex_count == 3);
  CHECK(
      with_name(read_ok(
          "ply\nformat ascii 1.0\ncomment TextureFile a.png\n" +
              replaced(kPlyVertices, "float z\n", "float z\nproperty half h\nproperty int64 id\n") +
              "element edge 1\nproperty int a\nend_header\n0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\n7\n",
          MeshFormat::kPly)) == "textures 1; edge 1; h 3; ");
  CHECK_THAT(failure(header("element face 1\n"), MeshFormat::kPly),
             Contains("no list vertex_indices"));
  CHECK_THAT(
      failure(header("element face 2\nproperty list uchar int vertex_indices\n") + "3 0 1 2\n0\n",
              MeshFormat::kPly),
      Contains("face 2 has no vertices"));
  CHECK_THAT(failure(header("element vertex 0\n"), MeshFormat::kPly),
             Contains("two elements are named vertex"));
  CHECK_THAT(failure(header("property float x\n"), MeshFormat::kPly),
             Contains("two properties of vertex are named x"));
  CHECK_THAT(failure(header("element face 1 2\n"), MeshFormat::kPly),
             Contains("line 7: '2' is not the end of the line"));
  CHECK_THAT(failure(replaced(kPly, "format ascii 1.0\n", ""), MeshFormat::kPly),
             Contains("format"));
  CHECK_THAT(failure(replaced(kPly, "ascii 1.0", "ascii 2.0"), MeshFormat::kPly),
             Contains("not PLY 1.0"));
}

TEST_CASE("PLY: rows of a text are as long as the header says") {
  CHECK_THAT(failure(replaced(kPly, "1 0 0\n", "1 0 0 0\n"), MeshFormat::kPly),
             Contains("entry 2 of 3: line 11: '0' is not"));
  CHECK_THAT(failure(replaced(kPly, "1 0 0\n", "1 0\n"), MeshFormat::kPly),
             Contains("entry 2 of 3: line 11: the line ends"));
  CHECK_THAT(failure(replaced(kPly, "3 0 1 2\n", "3 0 1 2 0\n"), MeshFormat::kPly),
             Contains("entry 1 of 1: line 13: '0' is not"));
  CHECK_THAT(failure(replaced(kPly, "3 0 1 2\n", "3 0 1\n"), MeshFormat::kPly),
             Contains("face list"));
  CHECK_THAT(failure(replaced(kPly, "3 0 1 2\n", "3 0 1 -1\n"), MeshFormat::kPly),
             Contains("face list"));
  CHECK_THAT(failure(replaced(kPly, "3 0 1 2\n", "-1\n"), MeshFormat::kPly), Contains("face list"));
  check_triangle(replaced(kPly, "1 0 0\n", "\n 1  0 0 \n\n"), MeshFormat::kPly);
}

TEST_CASE("PLY: binary data begin right behind the end of the header, whatever it is") {
  // Data that begin with what looks like an end of line.
  const std::vector<float> positions{std::bit_cast<float>(0x0a0d0a0du), 1, 2};
  const TestMesh mesh = test_mesh("m", positions, {});
  const std::string file = write_mesh(mesh.connectivity, positions, MeshFormat::kPly);
  const size_t data = file.find("end_header\n") + 11;
  for (const char* end : {"\n", "\r\n", "\n\r", "\r"}) {
    if (end == std::string("\r")) continue;  // looks like CR LF where 0a follows
    CHECK(same_bits(
        read_ok(replaced(file.substr(0, data), "\n", end) + file.substr(data), MeshFormat::kPly)
            .positions,
        positions));
  }
  const std::vector<float> other{std::bit_cast<float>(0x0a0d0a0au), 1, 2};
  const std::string bytes = write_mesh(mesh.connectivity, other, MeshFormat::kPly);
  CHECK(same_bits(
      read_ok(replaced(bytes.substr(0, data), "\n", "\r") + bytes.substr(data), MeshFormat::kPly)
          .positions,
      other));
}

TEST_CASE("PLY: indices and lists of numbers that are not whole are refused") {
  const auto file = [](float index) {
    std::string out =
        replaced(kPly.substr(0, kPly.find("0 0 0\n")), "ascii", "binary_little_endian");
    out = replaced(out, "uchar int", "uchar float") + std::string(36, '\0') + '\3';
    for (const float i : {0.0f, 1.0f, index}) {
      const auto bits = std::bit_cast<uint32_t>(i);
      for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(bits >> (8 * byte));
    }
    return out;
  };
  CHECK(read_ok(file(2), MeshFormat::kPly).connectivity.corners == Corners{0, 1, 2});
  CHECK_THAT(failure(file(1.5), MeshFormat::kPly), Contains("face list"));
  CHECK_THAT(failure(file(-1), MeshFormat::kPly), Contains("face list"));
  CHECK_THAT(failure(replaced(kPly, "list uchar", "list float"), MeshFormat::kPly),
             Contains("not whole"));
}

TEST_CASE("remainders stand beside the coordinates that binary32 does not hold") {
  const std::string far = "-2487002.881739";
  for (const auto& [format, text] : one_triangle()) {
    const MeshFrame frame = read_ok(replaced(text, "1 0 0", "1 0 " + far), format);
    REQUIRE(frame.remainders.size() == 9);
    for (size_t i = 0; i < 9; ++i)
      CHECK(frame.remainders[i] == (i == 5 ? Approx(0.118261) : Approx(0)));
    CHECK(read_ok(text, format).remainders.empty());
  }
  const auto binary = [](double x) {
    std::string out =
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty double z\nproperty double "
        "x\nproperty int y\nend_header\n" +
        std::string(8, '\0');
    const auto bits = std::bit_cast<uint64_t>(x);
    for (int byte = 7; byte >= 0; --byte) out += static_cast<char>(bits >> (8 * byte));
    return out + std::string("\x01\x00\x00\x01", 4);
  };
  const MeshFrame frame = read_ok(binary(1 + 0x1p-40), MeshFormat::kPly);
  CHECK(frame.positions == std::vector<float>{1, 16777216, 0});
  CHECK(frame.remainders == std::vector<float>{0x1p-40f, 1, 0});
}

}  // namespace reeb::tools
