// Streams of class *core* beside what the encoder makes of usual meshes: meshes at the bounds that
// the specification sets, and sections of random bytes, which mean something in every context.
#include <algorithm>
#include <utility>

#include "conformance/generate/parts.h"
#include "conformance/generate/stream.h"

namespace reeb::conformance {
namespace {

using namespace reeb::test;

class Maker {
 public:
  void add(const char* name, const char* sentence, Bytes bytes) {
    streams.push_back({"core", name, sentence, std::move(bytes)});
  }
  std::vector<Stream> streams;
};

/// Vertices all over the place.
Shape scattered_vertices(const char* name, uint32_t count, uint32_t seed) {
  Shape s{.name = name, .connectivity = {}, .positions = {}};
  const Bytes places = random_bytes(seed, size_t{3} * count);
  for (uint32_t v = 0; v < count; ++v)
    s.add_vertex(places[3 * v], places[3 * v + 1], places[3 * v + 2]);
  return s;
}

/// Triangles of three random vertices.
Shape soup(uint32_t vertices, uint32_t triangles, uint32_t seed) {
  Shape s = scattered_vertices("soup", vertices, seed);
  const Bytes corners = random_bytes(seed + 1, size_t{8} * triangles);
  for (size_t i = 0; s.connectivity.face_sizes.size() < triangles && i + 3 <= corners.size(); ++i) {
    const uint32_t a = corners[i] % vertices, b = corners[i + 1] % vertices;
    const uint32_t c = corners[i + 2] % vertices;
    if (a != b && b != c && c != a) s.add_face({a, b, c});
  }
  return s;
}

/// Every face again, every third the other way round.
Shape doubled(const Shape& shape) {
  Shape s = shape;
  for (size_t f = 0; f < shape.connectivity.face_sizes.size(); ++f) {
    std::vector<uint32_t> face(
        shape.connectivity.corners.begin() + static_cast<ptrdiff_t>(3 * f),
        shape.connectivity.corners.begin() + static_cast<ptrdiff_t>(3 * f + 3));
    if (f % 3 == 0) std::reverse(face.begin(), face.end());
    s.add_face(face);
  }
  return s;
}

/// Closed fans, each around a vertex of its own.
Shape fans(std::initializer_list<uint32_t> spokes) {
  Shape s{.name = "fans", .connectivity = {}, .positions = {}};
  for (const uint32_t n : spokes) {
    const Shape fan = hub(n);
    const uint32_t first = s.connectivity.vertex_count;
    for (uint32_t v = 0; v < fan.connectivity.vertex_count; ++v) {
      const float* p = &fan.positions[size_t{v} * 3];
      s.add_vertex(p[0] + 3 * static_cast<float>(n), p[1], p[2]);
    }
    for (size_t i = 0; i < fan.connectivity.corners.size(); i += 3) {
      const uint32_t* c = &fan.connectivity.corners[i];
      s.add_face({c[0] + first, c[1] + first, c[2] + first});
    }
  }
  return s;
}

BuiltMesh keeping_faces(const Shape& shape, bool plain, uint32_t bits = 9) {
  return build_mesh(shape.connectivity, on_grid(shape, bits), {.face_order = true, .plain = plain});
}

/// The same mesh for the main profile and, plain, for the fast one.
void add_both(Maker& m, const char* name, const char* fast_name, const char* sentence,
              const Shape& shape, uint32_t components) {
  m.add(name, sentence, build_file(keeping_faces(shape, false), plain_group(3, components)));
  m.add(fast_name, "The same in the fast profile.",
        build_fast(plain_group(5, components + 8), keeping_faces(shape, true)));
}

void add_meshes(Maker& m) {
  add_both(m, "soup", "fast_soup", "Triangles of random vertices, faces in order.", soup(40, 90, 1),
           5);
  add_both(m, "dense_soup", "fast_dense_soup",
           "Few vertices, each with more triangles than are looked at.", soup(14, 130, 3), 5);
  add_both(m, "doubled_faces", "fast_doubled_faces", "Every face twice, some the other way round.",
           doubled(torus(7, 5)), 4);
  add_both(m, "fans", "fast_fans", "Closed fans of 6 to 18 triangles.",
           fans({6, 7, 8, 9, 10, 15, 16, 17, 18}), 3);
  m.add("hub_256", "A vertex with as many triangles as collapses look at.",
        build_file(mesh_of(hub(256)), plain_group(1, 2)));
  m.add("hub_257", "The same with one triangle more.",
        build_file(mesh_of(hub(257)), plain_group(1, 2)));
}

/// Polygons of Draco's and listed faces of all sizes, over the same vertices.
Shape all_faces() {
  Shape s = mixed_polygons();
  const Connectivity odd = odd_faces();
  for (size_t f = 0, at = 0; f < odd.face_sizes.size(); at += odd.face_sizes[f++]) {
    s.add_face(std::vector<uint32_t>(odd.corners.begin() + static_cast<ptrdiff_t>(at),
                                     odd.corners.begin() + static_cast<ptrdiff_t>(at) +
                                         std::min<ptrdiff_t>(odd.face_sizes[f], 12)));
  }
  for (uint32_t v = 0; v < 4; ++v) s.add_face({v});
  s.add_face({1, 3, 1, 3, 2});
  return s;
}

void add_faces(Maker& m) {
  const Shape faces = all_faces();
  for (const bool plain : {false, true}) {
    for (uint32_t seed = 1; seed < 3; ++seed) {
      const BuiltMesh mesh =
          with_face_section(keeping_faces(faces, plain, 8), random_bytes(70 + seed, 120));
      const std::string name = std::string(plain ? "fast_" : "") + "faces_" + std::to_string(seed);
      m.add(name.c_str(), "Faces of all sizes in a random order, each from a random corner on.",
            plain ? build_fast(plain_group(1, 1), mesh) : build_file(mesh, plain_group(1, 1)));
    }
  }
}

BuiltGroup random_corrections(BuiltGroup g, const BuiltMesh& mesh, uint32_t seed) {
  g.header.correction_step = 0.01;
  set_correction_section(mesh, g, random_bytes(seed, 3000));
  return g;
}

void add_corrections(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(9, 8));
  const BuiltMesh plain = plain_mesh_of(torus(9, 8));
  m.add("corrections_1", "Corrections of random bytes.",
        build_file(mesh, random_corrections(plain_group(3, 1), mesh, 11)));
  m.add("corrections_2", "Corrections of random bytes, a single frame.",
        build_file(mesh, random_corrections(plain_group(1, 1), mesh, 12)));
  m.add("fast_corrections", "The same in the fast profile.",
        build_fast(random_corrections(plain_group(2, 1), plain, 13), plain));
  BuiltGroup g = plain_group(5, 2);
  g.header.correction_step = 0.001;
  g.correction = scattered;
  m.add("scattered_corrections", "Corrections of every size, and values that replace coordinates.",
        build_file(mesh, g));
}

}  // namespace

std::vector<Stream> pinning_streams() {
  Maker m;
  add_meshes(m);
  add_faces(m);
  add_corrections(m);
  return m.streams;
}

}  // namespace reeb::conformance
