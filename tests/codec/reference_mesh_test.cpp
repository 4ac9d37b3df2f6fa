#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>

#include "bitstream/bytes.h"
#include "bitstream/headers.h"
#include "bitstream/syntax.h"
#include "codec/dec/reference_mesh_decoder.h"
#include "codec/enc/reference/reference_mesh_encoder.h"

using namespace reeb;

namespace {

// 0 .. count-1.
uint32_t pick(std::mt19937& random, uint32_t count) {
  return static_cast<uint32_t>(random() % count);
}

using Face = std::vector<uint32_t>;
using Faces = std::vector<Face>;
using Bytes = std::vector<uint8_t>;

struct Mesh {
  Connectivity connectivity;
  std::vector<int32_t> grid;
};

// Positions pseudo-random, so that nothing depends on them by luck.
Mesh make_mesh(uint32_t vertices, const Faces& faces, uint32_t bits = 10) {
  Mesh m;
  m.connectivity.vertex_count = vertices;
  for (const Face& f : faces) {
    m.connectivity.face_sizes.push_back(static_cast<uint32_t>(f.size()));
    m.connectivity.corners.insert(m.connectivity.corners.end(), f.begin(), f.end());
  }
  std::mt19937 random(vertices);
  for (uint32_t i = 0; i < 3 * vertices; ++i) {
    m.grid.push_back(static_cast<int32_t>(random() & ((1u << bits) - 1)));
  }
  return m;
}

Faces faces_of(const Connectivity& c) {
  Faces out;
  size_t at = 0;
  for (const uint32_t size : c.face_sizes) {
    out.emplace_back(c.corners.begin() + static_cast<long>(at),
                     c.corners.begin() + static_cast<long>(at + size));
    at += size;
  }
  return out;
}

// The multiset of faces, each as its smallest rotation.
std::multiset<Face> face_set(const Faces& faces) {
  std::multiset<Face> out;
  for (const Face& f : faces) {
    Face best = f, turned = f;
    for (size_t i = 1; i < f.size(); ++i) {
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      best = std::min(best, turned);
    }
    out.insert(best);
  }
  return out;
}

// Triangles after an edge- or corner-wise fan of a face: two fewer than corners, each with all
// corners in the face.
void check_triangles(const ReferenceMesh& decoded) {
  size_t expected = 0;
  for (const Face& f : faces_of(decoded.connectivity)) {
    const std::set<uint32_t> distinct(f.begin(), f.end());
    if (distinct.size() == f.size() && f.size() > 2) expected += f.size() - 2;
  }
  CHECK(decoded.triangles.size() >= 3 * expected);
  CHECK(decoded.triangles.size() % 3 == 0);
  for (size_t t = 0; t < decoded.triangles.size(); t += 3) {
    const uint32_t* v = &decoded.triangles[t];
    CHECK((v[0] != v[1] && v[1] != v[2] && v[2] != v[0]));
    CHECK(std::max({v[0], v[1], v[2]}) < decoded.vertex_count);
  }
}

void check_round_trip(const Mesh& m, bool reorder, bool plain) {
  Bytes bytes;
  ReferenceMesh from_encoder, decoded;
  std::vector<uint32_t> input_index;
  const Status encoded =
      encode_reference(m.connectivity, m.grid, {reorder, plain}, bytes, from_encoder, input_index);
  INFO(encoded.message());
  REQUIRE(encoded.ok());
  REQUIRE(decode_reference(bytes, {}, decoded).ok());
  CHECK(decoded.grid == from_encoder.grid);
  CHECK(decoded.triangles == from_encoder.triangles);
  const uint32_t n = m.connectivity.vertex_count;
  REQUIRE(decoded.vertex_count == n);
  REQUIRE(decoded.output_index.size() == n);
  std::vector<uint32_t> sorted = decoded.output_index, all(n);
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0u);
  CHECK(sorted == all);
  check_triangles(decoded);
  if (reorder) {
    CHECK(decoded.output_index == all);
    CHECK(decoded.connectivity.face_sizes.size() == m.connectivity.face_sizes.size());
    return;
  }
  CHECK(decoded.connectivity.vertex_count == n);
  CHECK(face_set(faces_of(decoded.connectivity)) == face_set(faces_of(m.connectivity)));
  for (uint32_t v = 0; v < n; ++v) {
    for (size_t i = 0; i < 3; ++i) {
      REQUIRE(decoded.grid[3 * v + i] == m.grid[3 * decoded.output_index[v] + i]);
    }
  }
}

void check_both(const Mesh& m) {
  for (const bool plain : {false, true}) {
    check_round_trip(m, false, plain);
    check_round_trip(m, true, plain);
  }
}

// A torus of n by n quadrilaterals, or of triangles.
Faces torus(uint32_t n, bool quads) {
  Faces out;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t a = i * n + j, b = i * n + (j + 1) % n;
      const uint32_t c = (i + 1) % n * n + (j + 1) % n, d = (i + 1) % n * n + j;
      if (quads) {
        out.push_back({a, b, c, d});
      } else {
        out.push_back({a, b, c});
        out.push_back({a, c, d});
      }
    }
  }
  return out;
}

const Faces kTetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

}  // namespace

TEST_CASE("manifold triangle meshes survive", "[reference]") {
  check_both(make_mesh(3, {{0, 1, 2}}));
  check_both(make_mesh(4, kTetrahedron));
  check_both(make_mesh(6, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));  // strip
  check_both(make_mesh(49, torus(7, false)));
  check_both(make_mesh(7, {{0, 1, 2}, {3, 4, 5}, {5, 4, 6}}));  // two components
}

TEST_CASE("polygons survive", "[reference]") {
  check_both(make_mesh(49, torus(7, true)));
  check_both(make_mesh(8, {{0, 3, 2, 1},
                           {4, 5, 6, 7},
                           {0, 1, 5, 4},
                           {1, 2, 6, 5},
                           {2, 3, 7, 6},
                           {3, 0, 4, 7}}));  // cube
  check_both(make_mesh(9, {{0, 1, 2, 3, 4}, {3, 2, 5}, {4, 3, 5, 6, 7, 8}}));
  check_both(make_mesh(4, {{0, 1, 2, 3}, {3, 2, 1, 0}}));  // two sides of one quadrilateral
  check_both(make_mesh(6, {{0, 1, 2, 3}, {0, 2, 4, 5}}));  // an edge along the other's diagonal
}

TEST_CASE("isolated vertices and coincident ones survive", "[reference]") {
  check_both(make_mesh(9, {{1, 3, 5}, {5, 3, 7}}));
  Mesh m = make_mesh(49, torus(7, false));
  std::fill(m.grid.begin(), m.grid.end(), 3);
  check_both(m);
  m = make_mesh(49, torus(7, false), 1);
  check_both(m);
}

TEST_CASE("degenerate and repeated faces survive", "[reference]") {
  check_both(make_mesh(5, {{0, 1, 2}, {2, 2, 3}, {4, 4, 4}, {2, 1, 3}}));
  check_both(make_mesh(5, {{0}, {1, 2}, {3, 3}, {0, 1, 2}}));
  check_both(make_mesh(5, {{0, 1, 2}, {1, 2, 0}, {0, 1, 2}, {2, 1, 0}, {2, 1, 3}}));
  check_both(make_mesh(6, {{0, 1, 2, 1}, {0, 1, 2, 3}, {0, 1, 2, 3, 4, 2}, {3, 2, 5}}));
}

TEST_CASE("non-manifold meshes survive", "[reference]") {
  check_both(make_mesh(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));  // three on an edge
  check_both(make_mesh(5, {{0, 1, 2}, {0, 3, 4}}));             // two touch at a vertex
  check_both(make_mesh(5, {{0, 1, 2}, {0, 1, 3}}));             // neighbours wound differently
  Faces fan;
  for (uint32_t i = 2; i < 12; ++i) fan.push_back({0, 1, i});
  check_both(make_mesh(12, fan));
  check_both(make_mesh(10, {{0, 1, 2},
                            {1, 3, 2},
                            {2, 3, 4},
                            {3, 5, 4},
                            {4, 5, 1},
                            {5, 0, 1},
                            {0, 1, 5}}));  // a band closed with a twist
}

TEST_CASE("a mesh without anything for Draco survives", "[reference]") {
  check_both(make_mesh(1, {}));
  check_both(make_mesh(20, {}));
  check_both(make_mesh(3, {{0, 0, 1}, {2, 2, 2}}));
}

TEST_CASE("face soup survives", "[reference]") {
  std::mt19937 random(5);
  for (int round = 0; round < 60; ++round) {
    const uint32_t n = 3 + pick(random, 12);
    Faces faces(pick(random, 30));
    for (Face& f : faces) {
      f.resize(1 + pick(random, 6));
      for (uint32_t& v : f) v = pick(random, n);
    }
    check_both(make_mesh(n, faces, 1 + pick(random, 16)));
  }
}

TEST_CASE("soup of distinct corners survives", "[reference]") {
  std::mt19937 random(6);
  for (int round = 0; round < 60; ++round) {
    const uint32_t n = 6 + pick(random, 6);
    Faces faces(pick(random, 40));
    for (Face& f : faces) {
      Face all(n);
      std::iota(all.begin(), all.end(), 0u);
      std::shuffle(all.begin(), all.end(), random);
      f.assign(all.begin(), all.begin() + 3 + pick(random, 3));
    }
    check_both(make_mesh(n, faces, 4));
  }
}

TEST_CASE("input that is no mesh is refused", "[reference]") {
  Bytes bytes;
  ReferenceMesh decoded;
  const auto code = [&](const Mesh& m) {
    std::vector<uint32_t> input_index;
    return encode_reference(m.connectivity, m.grid, {}, bytes, decoded, input_index).code();
  };
  CHECK(code(make_mesh(0, {})) == StatusCode::kInvalidArgument);
  CHECK(code(make_mesh(3, {{0, 1, 3}})) == StatusCode::kInvalidArgument);
  CHECK(code(make_mesh(3, {{}})) == StatusCode::kInvalidArgument);
  Mesh m = make_mesh(3, {{0, 1, 2}});
  m.connectivity.face_sizes = {4};
  CHECK(code(m) == StatusCode::kInvalidArgument);
  m = make_mesh(3, {{0, 1, 2}});
  m.grid[4] = 65536;
  CHECK(code(m) == StatusCode::kInvalidArgument);
  m.grid.pop_back();
  CHECK(code(m) == StatusCode::kInvalidArgument);
}

TEST_CASE("limits bind before decoding", "[reference]") {
  const Mesh m = make_mesh(49, torus(7, false));
  Bytes bytes;
  ReferenceMesh decoded;
  std::vector<uint32_t> input_index;
  REQUIRE(encode_reference(m.connectivity, m.grid, {}, bytes, decoded, input_index).ok());
  const auto code = [&](const Limits& limits) {
    return decode_reference(bytes, limits, decoded).code();
  };
  CHECK(code({49, 98, 1, 1 << 20}) == StatusCode::kOk);
  CHECK(code({48, 98, 1, 1 << 20}) == StatusCode::kLimitExceeded);
  CHECK(code({49, 97, 1, 1 << 20}) == StatusCode::kLimitExceeded);
  CHECK(code({49, 98, 1, 1000}) == StatusCode::kLimitExceeded);
}

TEST_CASE("cut and altered bytes are errors or meshes, nothing else", "[reference]") {
  Faces faces = torus(6, true);
  faces.push_back({0, 1, 40});
  faces.push_back({3, 3, 3});
  const Mesh m = make_mesh(42, faces, 8);
  Bytes bytes;
  ReferenceMesh decoded;
  std::vector<uint32_t> input_index;
  REQUIRE(encode_reference(m.connectivity, m.grid, {}, bytes, decoded, input_index).ok());
  const Limits limits = {1000, 1000, 1, 1 << 24};
  for (size_t n = 0; n < bytes.size(); ++n) {
    CHECK_FALSE(decode_reference(std::span(bytes).first(n), limits, decoded).ok());
  }
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    if (!decode_reference(flipped, limits, decoded).ok()) continue;
    CHECK(decoded.output_index.size() == decoded.vertex_count);
    CHECK(decoded.grid.size() == 3 * decoded.vertex_count);
    for (const uint32_t v : decoded.connectivity.corners) CHECK(v < decoded.vertex_count);
  }
  std::mt19937 random(9);
  for (int round = 0; round < 500; ++round) {
    Bytes noisy = bytes;
    for (int k = 0; k < 6; ++k)
      noisy[pick(random, static_cast<uint32_t>(noisy.size()))] = static_cast<uint8_t>(random());
    if (decode_reference(noisy, limits, decoded).ok()) {
      CHECK(decoded.grid.size() == 3 * decoded.vertex_count);
    }
  }
}

TEST_CASE("huge counts over few bytes are refused", "[reference]") {
  MeshHeader h;
  h.vertex_count = 1u << 24;
  h.face_count = 1u << 25;
  Bytes bytes;
  REQUIRE(write_header(h, "mesh header", bytes).ok());
  ReferenceMesh decoded;
  CHECK(decode_reference(bytes, {}, decoded).code() == StatusCode::kCorrupt);

  Bytes section = {2};
  append_varuint(section, 1u << 24);
  append_varuint(section, 1u << 25);
  section.push_back(0);
  append_varuint(section, 1u << 25);
  append_varuint(section, 0);
  section.resize(40);
  h = {};
  h.draco_bytes = section.size();
  bytes.clear();
  REQUIRE(write_header(h, "mesh header", bytes).ok());
  bytes.insert(bytes.end(), section.begin(), section.end());
  const Status s = decode_reference(bytes, {}, decoded);
  CHECK(s.message() == "connectivity: more triangles than its bytes can hold");
}

TEST_CASE("meshes that cost nearly nothing are padded into the bound", "[reference]") {
  Mesh m = make_mesh(60000, {});
  std::fill(m.grid.begin(), m.grid.end(), 5);
  check_both(m);
}
