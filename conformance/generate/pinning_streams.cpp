// Streams of class *core* beside what the encoder makes of usual meshes: meshes at the bounds that
// the specification sets, and sections of random bytes, which mean something in every context.
#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "codec/dec/decoder.h"
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

/// Of item i of a table `columns` wide.
float row_of(uint32_t i, uint32_t columns) {
  const uint32_t row = i / columns;
  return static_cast<float>(row);
}

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

/// Triangles that share no vertex, side by side.
Shape separate(uint32_t triangles) {
  Shape s{.name = "separate triangles", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < triangles; ++i) {
    const auto x = static_cast<float>(i % 8), y = row_of(i, 8);
    const uint32_t v = s.add_vertex(x, y, 0);
    s.add_vertex(x + static_cast<float>(i % 3), y, 1);
    s.add_vertex(x, y + 1, static_cast<float>(i % 2));
    s.add_face({v, v + 1, v + 2});
  }
  return s;
}

/// Fins at places that differ in one coordinate alone.
Shape fins_at_four_places() {
  Shape s{.name = "fins", .connectivity = {}, .positions = {}};
  const Shape one = fins(5);
  for (uint32_t place = 0; place < 4; ++place) {
    const uint32_t first = s.connectivity.vertex_count;
    for (size_t i = 0; i < one.positions.size(); i += 3) {
      const auto moved = [&](uint32_t a) {
        return one.positions[i + a] + (place == a + 1 ? 2 : 0);
      };
      s.add_vertex(moved(0), moved(1), moved(2));
    }
    for (uint32_t i = 0; i < 5; ++i) s.add_face({first, first + 1, first + 2 + i});
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
  add_both(m, "separate", "fast_separate", "Triangles that share no vertex.", separate(40), 2);
  add_both(m, "four_fins", "fast_four_fins",
           "Split points at places that differ in one coordinate.", fins_at_four_places(), 2);
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
  for (uint32_t f = 0; f < 30; ++f) {
    std::vector<uint32_t> face;
    for (uint32_t i = 0; i < 5 + f % 6; ++i) face.push_back((f * 7 + i * 3) % 20);
    s.add_face(face);
  }
  s.add_face({1, 3, 1, 3, 2});
  return s;
}

/// Seven or nine vertices, any two of which are in one triangle: none of them is ever taken out.
void add_clump(Shape& s, uint32_t size) {
  static const std::vector<std::array<uint32_t, 3>> kSeven = {
      {0, 1, 3}, {1, 2, 4}, {2, 3, 5}, {3, 4, 6}, {4, 5, 0}, {5, 6, 1}, {6, 0, 2}};
  static const std::vector<std::array<uint32_t, 3>> kNine = {
      {0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 3, 6}, {1, 4, 7}, {2, 5, 8},
      {0, 4, 8}, {1, 5, 6}, {2, 3, 7}, {0, 5, 7}, {1, 3, 8}, {2, 4, 6}};
  const uint32_t first = s.connectivity.vertex_count;
  for (uint32_t i = 0; i < size; ++i) s.add_vertex(row_of(first, 40), 0, 0);
  for (const auto& t : size == 7 ? kSeven : kNine)
    s.add_face({first + t[0], first + t[1], first + t[2]});
}

/// Clumps beside a tetrahedron, which loses a vertex at a time.
Bytes clumps(uint32_t of_seven, uint32_t of_nine) {
  Shape s = tetrahedron();
  for (uint32_t i = 0; i < of_seven; ++i) add_clump(s, 7);
  for (uint32_t i = 0; i < of_nine; ++i) add_clump(s, 9);
  return build_file(build_listed_mesh(s.connectivity, on_grid(s, 5)), plain_group(1, 1));
}

/// Every vertex in triangles with the five before and after it, of which a sweep takes out no more
/// than the ends where positions do not count.
Shape band(uint32_t vertices) {
  Shape s{.name = "band", .connectivity = {}, .positions = {}};
  for (uint32_t v = 0; v < vertices; ++v)
    s.add_vertex(static_cast<float>(v % 20), row_of(v, 20), 0);
  for (uint32_t v = 0; v + 5 < vertices; ++v) {
    s.add_face({v, v + 1, v + 5});
    s.add_face({v, v + 2, v + 4});
    s.add_face({v, v + 3, v + 5});
  }
  return s;
}

/// A fan whose middle has `spokes` triangles, with a ring of triangles around it.
Shape wheel(uint32_t spokes) {
  Shape s = hub(spokes);
  for (uint32_t i = 0; i < spokes; ++i) {
    const float* p = &s.positions[size_t{i + 1} * 3];
    s.add_vertex(p[0] * 1.5f, p[1] * 1.5f, -1);
  }
  for (uint32_t i = 0; i < spokes; ++i) {
    const uint32_t next = (i + 1) % spokes;
    s.add_face({next + 1, i + 1, spokes + i + 1});
    s.add_face({next + 1, spokes + i + 1, spokes + next + 1});
  }
  return s;
}

/// Triangles at one vertex, whose others are coded before it: first all of one end, then one more.
Shape star(uint32_t triangles) {
  Shape s{.name = "star", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < 2 * triangles + 1; ++i)
    s.add_vertex(static_cast<float>(i % 24), row_of(i, 24), 0);
  for (uint32_t i = 0; i < triangles; ++i) s.add_face({2 * triangles, i, triangles + i});
  return s;
}

/// Grid positions of 16 bits, the corners of the grid among them.
std::vector<int32_t> far_places(uint32_t vertices) {
  const Bytes bytes = random_bytes(61, size_t{6} * vertices);
  std::vector<int32_t> grid;
  for (size_t i = 0; i < size_t{3} * vertices; ++i) {
    const int32_t x = bytes[2 * i] << 8 | bytes[2 * i + 1];
    grid.push_back(i < 6 ? static_cast<int32_t>(i % 2) * 65535 : x);
  }
  return grid;
}

void add_bounds(Maker& m) {
  m.add("clumps_399", "Collapses that go on: one vertex of 400 is taken out.", clumps(54, 2));
  m.add("clumps_400", "Collapses that stop: one vertex of 401 is taken out.", clumps(49, 6));
  const Shape strip = doubled_strip(300);
  m.add("slow_collapses", "Collapses that stop when every vertex could have been tried 32 times.",
        build_file(build_listed_mesh(strip.connectivity, on_grid(strip, 8)), plain_group(1, 1)));
  m.add("fast_slow_contraction", "The same in the fast profile.",
        build_fast(plain_group(1, 2), plain_mesh_of(band(300), 8)));
  m.add("wheel", "A surface around a vertex of 257 triangles.",
        build_file(mesh_of(wheel(257)), plain_group(1, 1)));
  const Shape many = star(300);
  m.add(
      "star", "A vertex whose index has more than 256 guesses.",
      build_file(build_listed_mesh(many.connectivity, on_grid(many, 5), true), plain_group(1, 1)));
  const Shape ring = torus(12, 9);
  const std::vector<int32_t> far = far_places(ring.connectivity.vertex_count);
  m.add("far_places", "Positions all over the grid.",
        build_file(build_mesh(ring.connectivity, far), plain_group(2, 2)));
  m.add("fast_far_places", "The same in the fast profile.",
        build_fast(plain_group(2, 2), build_mesh(ring.connectivity, far, {.plain = true})));
  m.add("fast_full", "More vertices than a base has, none of which can be taken out.",
        build_fast(plain_group(1, 2), plain_mesh_of(soup(80, 450, 5), 3)));
  m.add("many_points", "More loose vertices than are remembered.",
        build_file(mesh_of(points_only(400), 3), plain_group(1, 1)));
}

/// As many bytes of a section as its stream decodes with, and not one more.
void shorten(Bytes& section, const std::function<Bytes()>& file) {
  const Bytes all = section;
  size_t least = 0;
  for (size_t most = all.size(); least < most;) {
    const size_t middle = (least + most) / 2;
    section.assign(all.begin(), all.begin() + static_cast<ptrdiff_t>(middle));
    Sequence sequence;
    if (decode_sequence(file(), {}, sequence).ok()) {
      most = middle;
    } else {
      least = middle + 1;
    }
  }
  section.assign(all.begin(), all.begin() + static_cast<ptrdiff_t>(least));
}

/// A group of random sections.
BuiltGroup random_group(const BuiltMesh& mesh, uint32_t frames, uint32_t components,
                        uint32_t seed) {
  BuiltGroup g = plain_group(frames, components);
  g.coefficients = g.basis = nullptr;
  g.coefficient_section = random_bytes(seed, 4000);
  g.basis_section = random_bytes(seed + 1, 12000);
  shorten(g.coefficient_section, [&] { return build_file(mesh, g); });
  shorten(g.basis_section, [&] { return build_file(mesh, g); });
  return g;
}

void add_fields(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(5, 4));
  m.add("noise", "Random bytes for 110 components.",
        build_file(mesh, random_group(mesh, 37, 110, 21)));
  FileBuilder run({.total_frames = 45, .frame_rate = 30, .start_time = -0.5});
  run.reference({}, mesh);
  for (uint32_t i = 0; i < 3; ++i) {
    BuiltGroup g = plain_group(15, 37 + 3 * i);
    g.coefficients = g.basis = nullptr;
    g.coefficient_section = random_bytes(31 + 2 * i, 300);
    g.basis_section = random_bytes(32 + 2 * i, 700);
    g.header.first_frame = 15 * i;
    g.header.flags = i == 0 ? GroupHeader::kWeakPrior : GroupHeader::kContinues;
    run.group(mesh, g);
  }
  m.add("noise_run", "Groups of random bytes, with a weak prior, that continue one another.",
        run.finish());
  BuiltGroup thesis = thesis_group(12);
  thesis.coefficients = nullptr;
  thesis.coefficient_section = random_bytes(41, 1500);
  shorten(thesis.coefficient_section, [&] { return build_file(mesh, thesis); });
  m.add("thesis_noise", "Random bytes in the thesis profile.", build_file(mesh, thesis));
  BuiltGroup full = plain_group(60, 180);
  full.coefficients = full.basis = none;
  m.add("full_planes", "Planes of zeros, as many as the bytes of the group can hold.",
        build_file(mesh, full));
  BuiltGroup wide = plain_group(2, 6);
  wide.coefficients = [](uint32_t, uint32_t row) { return row == 0 ? 400 : 0; };
  wide.basis = [](uint32_t k, uint32_t row) { return k > 0 && row < 3 ? 700 - 9 * int64_t{k} : 0; };
  m.add("wide_sums", "Components that integers do not hold all of.",
        build_file(mesh_of(tetrahedron()), wide));
}

void add_motion(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(6, 5));
  BuiltGroup many = plain_group(14, 40);
  many.coefficients = none;
  many.header.region_count = 7;  // one with a single member, and one with none
  many.binding = [](uint32_t row) {
    return RegionBinding{row == 0 ? 5 : row / 7 % 5, row % 2 == 0 ? 0 : row % 5,
                         row % 2 == 0 ? 0 : row % 8 + 1};
  };
  many.transform = [](uint32_t k, uint32_t b) {
    if (k % 3 == 1) return MotionModel::Transform{};
    const auto x = static_cast<int32_t>(k * 7 + b * 3);
    return MotionModel::Transform{x % 5 - 2, x % 3, -(x % 7), x % 40};
  };
  m.add("many_motions", "Regions that move in most of 40 components.", build_file(mesh, many));
  BuiltGroup wrap = thesis_group(6);
  wrap.coefficients = none;
  wrap.header.region_count = 3;
  wrap.binding = many.binding;
  wrap.binding = [](uint32_t row) { return RegionBinding{row % 3, 0, row % 2 == 0 ? 8u : 0u}; };
  wrap.transform = [](uint32_t k, uint32_t b) {
    const auto x = static_cast<int32_t>((k / 3 + 1) * 0x30000000u + b);
    return MotionModel::Transform{x, -(x / 2), x / 3, x};
  };
  m.add("motion_wrap", "Transforms of the thesis profile that add up beyond 2^31.",
        build_file(mesh, wrap));
}

void add_faces(Maker& m) {
  const Shape faces = all_faces();
  for (const bool plain : {false, true}) {
    for (uint32_t seed = 1; seed < 3; ++seed) {
      const BuiltMesh mesh =
          with_face_section(keeping_faces(faces, plain, 8), random_bytes(70 + seed, 180));
      const std::string name = std::string(plain ? "fast_" : "") + "faces_" + std::to_string(seed);
      m.add(name.c_str(), "Faces of all sizes in a random order, each from a random corner on.",
            plain ? build_fast(plain_group(1, 1), mesh) : build_file(mesh, plain_group(1, 1)));
    }
  }
  m.add("faces_alone", "The same with the order of faces kept, and not that of vertices.",
        build_file(with_face_section(keeping_faces(faces, false, 8), random_bytes(73, 180), true),
                   plain_group(1, 1)));
}

/// Corrections of as many random bytes as there may be.
Bytes random_corrections(BuiltGroup g, const BuiltMesh& mesh, uint32_t seed) {
  g.header.correction_step = 0.01;
  for (size_t size = 3000;; size = size * 15 / 16) {
    BuiltGroup tried = g;
    if (!set_correction_section(mesh, tried, random_bytes(seed, size))) break;
    g = tried;
  }
  return build_file(mesh, g);
}

void add_corrections(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(9, 8));
  const BuiltMesh plain = plain_mesh_of(torus(9, 8));
  m.add("corrections_1", "Corrections of random bytes.",
        random_corrections(plain_group(3, 1), mesh, 11));
  m.add("corrections_2", "Corrections of random bytes, a single frame.",
        random_corrections(plain_group(1, 1), mesh, 12));
  BuiltGroup fast = plain_group(2, 1);
  fast.header.profile = Profile::kFast;
  m.add("fast_corrections", "The same in the fast profile.", random_corrections(fast, plain, 13));
  const BuiltMesh large = mesh_of(torus(30, 20), 3);
  BuiltGroup many = plain_group(1, 0);
  many.header.correction_step = 0.01;
  many.correction = [](uint32_t row, uint32_t, uint32_t axis) {
    const uint32_t random = (row * 3 + axis) * 2654435761u >> 16 ^ row * 40503u;
    return Correction{random % 7 < 2 ? 0 : random % 2 == 0 ? 1 : -1, false, 0};
  };
  m.add("many_corrections", "More corrections than contexts count.", build_file(large, many));
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
  add_bounds(m);
  add_fields(m);
  add_motion(m);
  add_faces(m);
  add_corrections(m);
  return m.streams;
}

}  // namespace reeb::conformance
