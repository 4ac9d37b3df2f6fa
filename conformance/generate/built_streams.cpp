// Streams of class *uncommon*: what the syntax allows and the encoder does not write.
#include <cmath>
#include <limits>

#include "conformance/generate/parts.h"
#include "tests/codec/shapes.h"

namespace reeb::conformance {
namespace {

using namespace reeb::test;

constexpr float kMinStep = std::numeric_limits<float>::denorm_min();
constexpr int32_t kMaxEntry = std::numeric_limits<int32_t>::max() - 1;

class Maker {
 public:
  void add(const char* name, const char* sentence, Bytes bytes) {
    streams.push_back({"uncommon", name, sentence, std::move(bytes)});
  }
  /// One that tells what no other core stream does.
  void pin(const char* name, const char* sentence, Bytes bytes) {
    streams.push_back({"core", name, sentence, std::move(bytes)});
  }
  std::vector<Stream> streams;
};

/// The stream that spec/example.md explains byte by byte.
Bytes worked_example() {
  Shape triangle{.name = "triangle", .connectivity = {}, .positions = {}};
  for (int i = 0; i < 3; ++i) triangle.add_vertex(0, 0, 0);
  triangle.add_face({0, 1, 2});
  const std::vector<int32_t> grid = {0, 0, 0, 200, 0, 0, 0, 100, 0};
  const BuiltMesh mesh = build_mesh(triangle.connectivity, grid);
  BuiltGroup g = plain_group(2, 1);
  g.coefficients = [](uint32_t, uint32_t row) { return int64_t{2} - 3 * row; };
  g.basis = [](uint32_t k, uint32_t row) { return k == 0 ? int64_t{row} - 1 : row == 3 ? 2 : 0; };
  FileBuilder file({.total_frames = 2, .frame_rate = 30});
  file.metadata({{"name", "example"}});
  file.reference({.origin = {-1, 0, 0.5f}, .grid_step = 0.01f}, mesh);
  file.group(mesh, g);
  return file.finish();
}

void add_containers(Maker& m) {
  m.add("example", "The stream that the specification explains byte by byte.", worked_example());

  const BuiltMesh mesh = mesh_of(tetrahedron());
  FileBuilder unknown({.total_frames = 4});
  unknown.chunk("xtra", random_bytes(1, 100));
  unknown.reference({}, mesh);
  unknown.chunk("aAAA", {});
  unknown.group(mesh, plain_group(2, 1));
  unknown.chunk("note", random_bytes(2, 3));
  BuiltGroup second = plain_group(2, 1);
  second.header.first_frame = 2;
  unknown.group(mesh, second);
  unknown.chunk("zzzz", random_bytes(3, 200));
  m.add("unknown_chunks", "Unknown ancillary chunks wherever they may stand.", unknown.finish());

  FileBuilder meta({.total_frames = 2});
  meta.metadata({{"a", "1"}, {"a", "2"}, {"", ""}});
  meta.chunk("meta", {0});
  meta.reference({}, mesh);
  meta.metadata({{"\xCE\xA9\x01", "\xF0\x9F\xA6\x8E\n"}});
  meta.group(mesh, plain_group(2, 1));
  meta.metadata({{"after", "the last group"}});
  m.add("metadata_everywhere", "Several chunks of metadata, one empty, one beyond ASCII.",
        meta.finish());
}

void add_extremes(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(7, 5));
  FileBuilder edges({.total_frames = 3, .shot_count = 2, .frame_rate = 1e9, .start_time = -1e15});
  edges.reference({.origin = {-3e38f, 1e-45f, 3e38f}, .grid_step = 0}, mesh);
  edges.group(mesh, plain_group(2, 2));
  edges.reference({.shot = 1, .first_frame = 2, .grid_step = 3e38f}, mesh);
  BuiltGroup last = plain_group(1, 1);
  last.header.first_frame = 2;
  last.header.shot = 1;
  edges.group(mesh, last);
  m.add("header_extremes", "Fields of headers at the ends of their ranges.", edges.finish());

  BuiltGroup g = plain_group(3, 2);
  g.header.quantization_step = kMinStep;
  m.add("least_step", "The least quantization_step: subnormal factors.", build_file(mesh, g));
  g.header.quantization_step = 1e36f;
  m.add("large_step", "A large quantization_step.", build_file(mesh, g));
  BuiltGroup t = thesis_group(2);
  t.header.axis_step[0] = kMinStep;
  t.header.axis_step[1] = 1e36f;
  m.add("thesis_steps", "Steps of the thesis profile far from each other.", build_file(mesh, t));
}

void add_components(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(9, 8));
  m.add("no_components", "No component: every vertex goes along with the mean.",
        build_file(mesh, plain_group(5, 0)));
  m.add("all_components", "As many components as coordinates of the group.",
        build_file(mesh, plain_group(4, 12)));
  m.add("fast_all_components", "The same in the fast profile.",
        build_fast(plain_group(4, 12), plain_mesh_of(torus(9, 8))));
  m.add("fast_on_other_mesh", "The fast profile on a mesh that is not plain.",
        build_fast(plain_group(8, 24), mesh_of(torus(9, 8))));
  BuiltGroup zero = plain_group(3, 3);
  zero.coefficients = none;
  m.add("zero_planes", "Components without a coefficient: norms of 0.", build_file(mesh, zero));
  FileBuilder mixed({.total_frames = 6});
  mixed.reference({.origin = {1, 2, 3}}, mesh);
  const Profile profiles[] = {Profile::kThesis, Profile::kMain, Profile::kThesis};
  for (uint32_t i = 0; i < 3; ++i) {
    BuiltGroup g = profiles[i] == Profile::kThesis ? thesis_group(2) : plain_group(2, 3);
    g.header.profile = profiles[i];
    g.header.first_frame = 2 * i;
    mixed.group(mesh, g);
  }
  m.add("profiles_mixed", "Groups of the main and the thesis profile in one shot.", mixed.finish());
}

/// As many groups in a row as may continue each other, then one that continues none.
void add_open_groups(Maker& m) {
  const BuiltMesh mesh = mesh_of(strip(6));
  FileBuilder file({.total_frames = 65});
  file.reference({}, mesh);
  // A group is coded after the fields of the one before, which only the encoder keeps: sections of
  // random bytes mean something after any.
  for (uint32_t i = 0; i < 65; ++i) {
    BuiltGroup g = plain_group(1, 2);
    g.header.first_frame = i;
    g.header.flags = i % 64 == 0 ? 0 : GroupHeader::kContinues;
    g.coefficients = g.basis = nullptr;
    g.coefficient_section = random_bytes(100 + i, 100);
    g.basis_section = random_bytes(200 + i, 60);
    file.group(mesh, g);
  }
  m.add("longest_run", "63 groups that continue the one before, each of random bytes.",
        file.finish());
}

void add_residuals(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(9, 8));
  const BuiltMesh plain = plain_mesh_of(torus(9, 8));
  BuiltGroup g = plain_group(4, 5);
  g.header.quantization_step = 1e-9f;
  g.coefficients = leap;
  m.add("escapes", "Escapes of every length in the coefficients.", build_file(mesh, g));
  m.add("fast_escapes", "The same in the fast profile.", build_fast(g, plain));
  BuiltGroup b = plain_group(30, 3);
  b.header.quantization_step = 1e-9f;
  b.basis = leap;
  m.add("basis_escapes", "Escapes of every length in the basis.", build_file(mesh, b));
  BuiltGroup t = thesis_group(2);
  t.coefficients = leap;
  m.add("thesis_escapes", "Escapes of every length in the thesis profile.", build_file(mesh, t));
  BuiltGroup r = plain_group(6, 4);
  r.coefficients = r.basis = nullptr;
  r.coefficient_section = random_bytes(4, 3000);
  r.basis_section = random_bytes(5, 3000);
  m.add("random_sections", "Random bytes for coefficients and basis, more than are read.",
        build_file(mesh, r));
}

void add_motion(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(10, 7));
  const BuiltMesh plain = plain_mesh_of(torus(10, 7));
  BuiltGroup g = plain_group(3, 4);
  g.header.region_count = 1024;
  g.binding = [](uint32_t row) {
    const uint32_t region = row * 37 % 1024;
    return RegionBinding{region, row % 4 == 0 ? region : (row * 11 + 5) % 1024, row % 8 + 1};
  };
  g.transform = [](uint32_t k, uint32_t b) {
    const auto x = static_cast<int32_t>(b * 40503u + k);
    if (k == 1) return MotionModel::Transform{};
    if (b % 512 == 7) return MotionModel::Transform{kMaxEntry, -kMaxEntry, 1 << 20, kMaxEntry};
    return MotionModel::Transform{x % 5, x % 3, -(x % 7), x % 100};
  };
  m.add("motion_extremes",
        "1024 regions, most of them empty; all weights, both regions the same, largest transforms.",
        build_file(mesh, g));
  m.add("fast_motion_extremes", "The same in the fast profile.", build_fast(g, plain));

  BuiltGroup t = thesis_group(4);
  t.header.region_count = 2;
  t.binding = [](uint32_t row) { return RegionBinding{row % 2, 0, row % 3 == 0 ? 8u : 0u}; };
  t.transform = [](uint32_t k, uint32_t b) {
    const int32_t x = (k / 3 + b) % 2 != 0 ? kMaxEntry / 2 : -kMaxEntry / 2;
    return MotionModel::Transform{x, -x, x, x};
  };
  m.add("thesis_wrap", "Transforms of the thesis profile whose differences are large.",
        build_file(mesh, t));

  BuiltGroup still = plain_group(2, 2);
  still.header.region_count = 3;
  still.binding = [](uint32_t) { return RegionBinding{2, 0, 1}; };
  still.transform = [](uint32_t, uint32_t) { return MotionModel::Transform{}; };
  m.pin("motion_unused", "Regions without any motion.", build_file(mesh, still));
}

void add_corrections(Maker& m) {
  const BuiltMesh mesh = mesh_of(torus(9, 8));
  BuiltGroup g = plain_group(5, 3);
  g.header.correction_step = 0.001;
  g.correction = scattered;
  m.add("corrections", "Corrections of every size, and values that replace coordinates.",
        build_file(mesh, g));
  BuiltGroup thesis = thesis_group(3);
  thesis.header.correction_step = 1e-300;
  thesis.correction = scattered;
  m.add("thesis_corrections", "The same in the thesis profile, in steps too small to matter.",
        build_file(mesh, thesis));
  g.correction = [](uint32_t, uint32_t, uint32_t) { return Correction{}; };
  m.add("no_corrections", "The bit for corrections, and none: their section is not empty.",
        build_file(mesh, g));
  g.correction = [](uint32_t row, uint32_t t, uint32_t) {
    return row == 5 && t == 2 ? Correction{0, true, std::numeric_limits<float>::quiet_NaN()}
                              : Correction{};
  };
  m.streams.push_back({"faulty", "correction_not_a_number", "A correction that is no number.",
                       build_file(mesh, g), "corrupt"});
  g.correction = [](uint32_t, uint32_t t, uint32_t a) {
    return Correction{t == a ? 0 : 5, false, 0};
  };
  m.add("dense_corrections", "Nearly every coordinate corrected.", build_file(mesh, g));
}

void add_meshes(Maker& m) {
  std::vector<int32_t> grid;
  grid.reserve(36);
  for (int32_t i = 0; i < 36; ++i) grid.push_back(i * i * 50);
  m.add("listed_faces",
        "Every face listed: of 1, 2 and 300 corners, repeated, over and over the same vertex.",
        build_file(build_listed_mesh(odd_faces(), grid), plain_group(2, 1)));
  const Shape small = two_components();
  m.add("listed_surface", "A surface of listed triangles, nothing by Draco.",
        build_file(build_listed_mesh(small.connectivity, on_grid(small, 8)), plain_group(2, 2)));
  const Shape ring = torus(12, 9);
  std::vector<int32_t> corner(size_t{ring.connectivity.vertex_count} * 3);
  m.pin("one_place", "All vertices at one grid point.",
        build_file(build_mesh(ring.connectivity, corner), plain_group(2, 2)));
  m.pin("plain_one_place", "The same in a plain mesh.",
        build_fast(plain_group(2, 2), build_mesh(ring.connectivity, corner, {.plain = true})));
  std::vector<int32_t> jumps;
  for (size_t i = 0; i < corner.size(); ++i)
    jumps.push_back(i % 4 == 0 ? 65535 : static_cast<int32_t>(i * 40503 % 65536) * (i % 3 != 0));
  m.add("jumping_positions", "Positions all over the grid, its corners included.",
        build_file(build_mesh(ring.connectivity, jumps), plain_group(2, 2)));
  m.add("plain_jumping_positions", "The same in a plain mesh.",
        build_fast(plain_group(2, 2), build_mesh(ring.connectivity, jumps, {.plain = true})));
  m.add("plain_hub", "A vertex with 300 triangles in a plain mesh: its list is full.",
        build_fast(plain_group(3, 9), plain_mesh_of(hub(300))));
  const Shape loose = points_only(40);
  std::vector<int32_t> far;
  for (size_t i = 0; i < 120; ++i) far.push_back(i % 7 == 0 ? 65535 : static_cast<int32_t>(i % 5));
  m.add("jumping_points", "Loose vertices that repeat and jump.",
        build_file(build_mesh(loose.connectivity, far), plain_group(2, 2)));
}

void add_levels(Maker& m) {
  const Shape large = torus(256, 256);
  const std::vector<int32_t> still(size_t{large.connectivity.vertex_count} * 3);
  BuiltGroup g = plain_group(1, 0);
  g.basis = none;
  m.add("level1_vertices", "The most vertices and faces of level 1.",
        build_file(build_mesh(large.connectivity, still, {.reorder = true}), g));
  const BuiltMesh mesh = mesh_of(tetrahedron());
  m.add("level1_frames", "The most frames and components of a group of level 1.",
        build_file(mesh, plain_group(512, 128)));
  BuiltGroup longest = plain_group(65536, 0);
  longest.basis = [](uint32_t, uint32_t row) { return row % 1000 == 0 ? 3 : 0; };
  m.add("longest_group", "A group of 65536 frames.", build_file(mesh_of(single_vertex()), longest));
}

}  // namespace

std::vector<Stream> built_streams() {
  Maker m;
  add_containers(m);
  add_extremes(m);
  add_components(m);
  add_open_groups(m);
  add_residuals(m);
  add_motion(m);
  add_corrections(m);
  add_meshes(m);
  add_levels(m);
  return m.streams;
}

}  // namespace reeb::conformance
