#include "codec/dec/connectivity/connectivity_decoder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "bitstream/container.h"
#include "bitstream/syntax.h"
#include "codec/enc/reference/draco_connectivity_encoder.h"
#include "tests/codec/draco_reading.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

using Bytes = std::vector<uint8_t>;
using Triangles = std::vector<uint32_t>;

constexpr Limits kLimits = {1u << 20, 1u << 20, 1, 1u << 28};

Status decode(std::span<const uint8_t> section, PointTriangles& out) {
  return decode_connectivity(section, kLimits, 1u << 20, out);
}

// 0 .. count-1.
uint32_t pick(std::mt19937& random, size_t count) {
  return static_cast<uint32_t>(random() % count);
}

// The vertices that triangles use, numbered without gaps.
Triangles used_alone(Triangles triangles, uint32_t& count) {
  std::map<uint32_t, uint32_t> number;
  for (uint32_t& v : triangles) {
    v = number.try_emplace(v, static_cast<uint32_t>(number.size())).first->second;
  }
  count = static_cast<uint32_t>(number.size());
  return triangles;
}

/// What Draco writes of triangles; empty where it takes none.
Bytes section_of(const Triangles& triangles) {
  uint32_t count = 0;
  const Triangles used = used_alone(triangles, count);
  DracoEncoding encoding;
  return encode_draco_connectivity(used, count, encoding) ? encoding.section : Bytes{};
}

// A torus with triangles left out here and there: handles and holes.
Triangles holed_torus(uint32_t around, uint32_t across, uint32_t seed) {
  const Triangles whole = triangles_of(torus(around, across).connectivity);
  std::mt19937 random(seed);
  Triangles out;
  for (size_t t = 0; t < whole.size(); t += 3) {
    if (pick(random, 9) != 0) out.insert(out.end(), &whole[t], &whole[t] + 3);
  }
  return out;
}

// Cells of a box, removed at random; what is left has handles, and touches itself at edges.
Triangles sponge(uint32_t n, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<bool> solid(n * n * n);
  for (size_t i = 0; i < solid.size(); ++i) solid[i] = pick(random, 3) != 0;
  const auto is_solid = [&](const std::array<uint32_t, 3>& c) {
    return std::all_of(c.begin(), c.end(), [n](uint32_t x) { return x < n; }) &&
           solid[(c[0] * n + c[1]) * n + c[2]];
  };
  Triangles out;
  for (uint32_t cell = 0; cell < n * n * n; ++cell) {
    const std::array<uint32_t, 3> c = {cell / (n * n), cell / n % n, cell % n};
    if (!is_solid(c)) continue;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      for (const uint32_t side : {0u, 1u}) {
        auto beyond = c;
        beyond[axis] += side != 0 ? 1 : std::numeric_limits<uint32_t>::max();
        if (is_solid(beyond)) continue;
        const auto corner = [&](uint32_t i, uint32_t j) {
          auto at = c;
          at[axis] += side;
          at[(axis + 1) % 3] += side != 0 ? i : j;
          at[(axis + 2) % 3] += side != 0 ? j : i;
          return (at[0] * (n + 1) + at[1]) * (n + 1) + at[2];
        };
        for (const uint32_t v :
             {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)})
          out.push_back(v);
      }
    }
  }
  return out;
}

// Triangles of three different vertices of a few: all that a mesh can get wrong.
Triangles soup(uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t vertices = 4 + pick(random, 12);
  Triangles out;
  while (out.size() < size_t{3} * count) {
    const uint32_t a = pick(random, vertices), b = pick(random, vertices),
                   c = pick(random, vertices);
    if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
  }
  return out;
}

std::vector<Bytes> all_sections() {
  std::vector<Triangles> meshes = {grid_triangles(2), grid_triangles(9), grid_triangles(40)};
  for (const Shape& shape : small_shapes()) meshes.push_back(triangles_of(shape.connectivity));
  for (uint32_t seed = 0; seed < 20; ++seed) {
    meshes.push_back(holed_torus(6 + seed, 5 + seed, seed));
    meshes.push_back(sponge(2 + seed % 5, seed));
    meshes.push_back(soup(3 + 2 * seed, seed));
  }
  // More than a thousand triangles: the other traversal.
  meshes.push_back(triangles_of(torus(60, 40).connectivity));
  for (uint32_t seed = 0; seed < 8; ++seed) {
    meshes.push_back(holed_torus(30 + seed, 25, seed));
    meshes.push_back(sponge(7 + seed % 3, seed));
  }
  std::vector<Bytes> out;
  for (const Triangles& mesh : meshes) {
    Bytes section = mesh.empty() ? Bytes{} : section_of(mesh);
    if (!section.empty()) out.push_back(std::move(section));
  }
  return out;
}

// One or a few edits: bits, bytes, lengths, or an end of another section.
Bytes mutated(const Bytes& section, const Bytes& other, std::mt19937& random) {
  Bytes out = section;
  for (uint32_t edits = 1 + pick(random, 3); edits > 0 && !out.empty(); --edits) {
    const uint32_t at = pick(random, out.size());
    const auto place = out.begin() + at;
    switch (pick(random, 5)) {
      case 0:
        *place ^= static_cast<uint8_t>(1u << pick(random, 8));
        break;
      case 1:
        *place = static_cast<uint8_t>(random());
        break;
      case 2:
        out.erase(place);
        break;
      case 3:
        out.insert(place, static_cast<uint8_t>(random()));
        break;
      default:
        if (at >= other.size()) break;
        out.resize(at);
        out.insert(out.end(), other.begin() + at, other.end());
    }
  }
  return out;
}

/// Whether the section decodes; Draco then reads the same.
bool agrees_with_draco(std::span<const uint8_t> section) {
  PointTriangles ours, theirs;
  if (!decode(section, ours).ok()) return false;
  REQUIRE(read_by_draco(section, theirs));
  REQUIRE(ours.point_count == theirs.point_count);
  REQUIRE(ours.triangles == theirs.triangles);
  return true;
}

Bytes file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

std::span<const uint8_t> section_in(const ReferenceChunk& reference) {
  ByteReader in(reference.mesh);
  MeshHeader h;
  REQUIRE(read_header(in, "mesh header", h).ok());
  return in.take(h.draco_bytes);
}

}  // namespace

// Symbols by hand: the first triangle, one across its edge 1-2 to a new point, one between edges
// 1-3 and 0-1; then the start, which no symbol tells.
TEST_CASE("a tetrahedron is decoded as by hand", "[edgebreaker]") {
  const Bytes section = {0, 4, 4, 0, 3, 0, 0, 1, 0b0'101'111, 1, 1, 0x10};
  PointTriangles mesh;
  const Status status = decode(section, mesh);
  INFO(status.message());
  REQUIRE(status.ok());
  CHECK(mesh.point_count == 4);
  CHECK(mesh.triangles == Triangles{0, 1, 2, 2, 1, 3, 1, 0, 3, 2, 3, 0});
  CHECK(agrees_with_draco(section));
}

TEST_CASE("sections that cannot be are corrupt", "[edgebreaker]") {
  const Bytes good = {0, 4, 4, 0, 3, 0, 0, 1, 0b0'101'111, 1, 1, 0x10};
  const auto message = [&](size_t at, uint8_t byte) {
    Bytes bytes = good;
    bytes[at] = byte;
    PointTriangles mesh;
    const Status s = decode(bytes, mesh);
    CHECK(s.code() == StatusCode::kCorrupt);
    return s.message();
  };
  const std::string counts = "connectivity: its counts are impossible";
  const std::string codes = "connectivity: its codes are malformed";
  const std::string surface = "connectivity: its symbols do not make its surface";
  CHECK(message(0, 1) == "connectivity: unknown traversal");
  CHECK(message(1, 10) == counts);            // three points a symbol at most
  CHECK(message(2, 5) == counts);             // a start for three symbols at most
  CHECK(message(3, 1) == counts);             // attribute tables
  CHECK(message(4, 5) == counts);             // more symbols than triangles
  CHECK(message(5, 4) == counts);             // more splits than symbols
  CHECK(message(1, 5) == surface);            // another number of points
  CHECK(message(5, 1) == surface);            // no split to join them
  CHECK(message(8, 0x6F) == surface);         // a bit that is left is not 0
  CHECK(message(8, 0b0'000'111) == surface);  // an edge closed with itself
  CHECK(message(8, 0b0'001'111) == surface);  // a split without another edge
  CHECK(message(9, 0) == codes);              // a bit that cannot be
  CHECK(message(11, 0x11) == surface);        // something left in the state
  CHECK(message(10, 2) == codes);             // more bytes than there are
}

TEST_CASE("what Draco writes is decoded as Draco decodes it", "[edgebreaker]") {
  std::array<uint32_t, 3> traversals = {};
  uint32_t splits = 0, waiting = 0;
  for (const Bytes& section : all_sections()) {
    INFO("section of " << section.size() << " bytes");
    CHECK(agrees_with_draco(section));
    ByteReader in(section);
    ++traversals[in.u8()];
    for (int i = 0; i < 2; ++i) in.varuint();
    in.u8();
    in.varuint();
    splits += in.varuint() > 0;
    waiting += in.varuint() > 0;
  }
  CHECK(traversals[0] > 10);
  CHECK(traversals[2] > 10);
  CHECK(splits > 20);
  CHECK(waiting > 20);
}

TEST_CASE("sections of the conformance streams are decoded as by Draco", "[edgebreaker]") {
  uint32_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(REEB_STREAMS)) {
    if (entry.path().extension() != ".reeb") continue;
    const Bytes file = file_bytes(entry.path());
    ContainerReader reader;
    if (!reader.parse(file, {}).ok()) continue;
    const bool faulty = entry.path().string().find("/faulty/") != std::string::npos;
    for (const ReferenceChunk& reference : reader.references) {
      const auto section = section_in(reference);
      INFO(entry.path());
      if (!section.empty()) CHECK((agrees_with_draco(section) || faulty));
      ++count;
    }
  }
  CHECK(count > 100);
}

TEST_CASE("Draco reads every damaged section that is decoded", "[edgebreaker]") {
  const std::vector<Bytes> sections = all_sections();
  std::mt19937 random(1);
  uint32_t decoded = 0;
  for (size_t i = 0; i < sections.size(); ++i) {
    const Bytes& other = sections[pick(random, sections.size())];
    for (int round = 0; round < 400; ++round)
      decoded += agrees_with_draco(mutated(sections[i], other, random));
  }
  CHECK(decoded > 300);
}

TEST_CASE("a section cut short is corrupt", "[edgebreaker]") {
  for (const Bytes& section : all_sections()) {
    const size_t step = 1 + section.size() / 50;
    for (size_t n = 0; n < section.size(); n += step) {
      PointTriangles mesh;
      CHECK(decode(std::span(section).first(n), mesh).code() == StatusCode::kCorrupt);
    }
  }
}
