#include "segmentation/segmentation.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;
using Eigen::Vector3d;
using shapes::Mesh;

namespace {

Result segment_mesh(const Mesh& mesh) { return segment(mesh.positions, mesh.triangles); }

// What must hold whatever the input.
void require_valid(const Result& result, size_t vertices) {
  REQUIRE(result.labels.size() == vertices);
  REQUIRE(result.scalar.size() == vertices);
  const std::set<uint32_t> used(result.labels.begin(), result.labels.end());
  REQUIRE(used.size() == result.region_count);
  if (vertices > 0) REQUIRE(*used.rbegin() + 1 == result.region_count);
  for (const double f : result.scalar) REQUIRE((f >= 0 && f <= 1));
  for (const Arc& arc : result.graph.arcs) {
    REQUIRE(arc.region < result.region_count);
    REQUIRE(std::max(arc.from, arc.to) < result.graph.nodes.size());
  }
  REQUIRE(result.region_areas.size() == result.region_count);
}

// Regions are connected along the edges of the mesh.
bool regions_connected(const Mesh& mesh, const std::vector<uint32_t>& labels) {
  std::vector<uint32_t> part(mesh.vertex_count());
  for (uint32_t v = 0; v < part.size(); ++v) part[v] = v;
  bool changed = true;
  while (changed) {
    changed = false;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
      const uint32_t u = mesh.triangles[i], v = mesh.triangles[i - i % 3 + (i + 1) % 3];
      if (labels[u] != labels[v] || part[u] == part[v]) continue;
      part[u] = part[v] = std::min(part[u], part[v]);
      changed = true;
    }
  }
  std::map<uint32_t, uint32_t> part_of_label;
  for (uint32_t v = 0; v < part.size(); ++v) {
    if (part_of_label.try_emplace(labels[v], part[v]).first->second != part[v]) return false;
  }
  return true;
}

uint32_t genus(const Mesh& mesh) {
  return static_cast<uint32_t>((2 - shapes::euler_characteristic(mesh)) / 2);
}

double double_torus(const Vector3d& p) {
  const auto ring = [&](double x) {
    const double r = std::hypot(p.x() - x, p.y()) - 0.8;
    return std::hypot(r, p.z()) - 0.3;
  };
  return std::min(ring(-0.85), ring(0.85));
}

double hand(const Vector3d& p) {
  double value = shapes::capsule(p, {0, -1, 0}, {0, 0, 0}, 0.3);
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.55 * (i - 2);
    const Vector3d direction(std::sin(angle), std::cos(angle), 0);
    const Vector3d root = 0.45 * direction;
    value = std::min(value, shapes::capsule(p, Vector3d::Zero(), root, 0.25));
    value = std::min(value, shapes::capsule(p, root, 1.5 * direction, 0.11));
  }
  return value;
}

}  // namespace

TEST_CASE("a sphere has two extremities and one arc") {
  const Mesh mesh = shapes::ellipsoid(4, 1, 1, 1);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  REQUIRE(result.feature_points.size() == 2);
  const auto at = [&](size_t i) {
    const float* p = &mesh.positions[3 * result.feature_points[i]];
    return Vector3d(p[0], p[1], p[2]);
  };
  CHECK((at(0) + at(1)).norm() < 0.2);  // opposite to each other
  CHECK(result.graph.arcs.size() == 1);
  CHECK(result.graph.nodes.size() == 2);
  CHECK(result.graph.loops() == 0);
  CHECK(result.region_count == 1);
  CHECK(result.warnings.empty());
}

TEST_CASE("a long ellipsoid has its extremities at the tips") {
  const Mesh mesh = shapes::ellipsoid(4, 1, 1, 4);
  const Result result = segment_mesh(mesh);
  REQUIRE(result.feature_points.size() == 2);
  for (const uint32_t v : result.feature_points) {
    CHECK(std::abs(mesh.positions[3 * v + 2]) > 3.8F);
  }
  CHECK(result.graph.arcs.size() == 1);
}

TEST_CASE("the graph of a torus has one loop") {
  const Mesh mesh = shapes::torus(60, 24, 2, 0.6);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  CHECK(result.graph.loops() == 1);
  CHECK(regions_connected(mesh, result.labels));
}

TEST_CASE("the graph of a double torus has two loops") {
  const Mesh mesh = shapes::implicit_surface(double_torus, 2.2, 44);
  REQUIRE(genus(mesh) == 2);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  CHECK(result.graph.loops() == 2);
  CHECK(regions_connected(mesh, result.labels));
}

TEST_CASE("a hand has five fingers and a wrist") {
  const Mesh mesh = shapes::implicit_surface(hand, 1.9, 64);
  REQUIRE(genus(mesh) == 0);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  CHECK(result.feature_points.size() == 6);
  CHECK(result.graph.loops() == 0);
  uint32_t leaves = 0;
  for (const Node& node : result.graph.nodes) leaves += node.type == NodeType::kMinimum;
  CHECK(leaves == 6);
  CHECK(regions_connected(mesh, result.labels));
  // The tips lie in six different regions.
  std::set<uint32_t> tips;
  for (const uint32_t v : result.feature_points) tips.insert(result.labels[v]);
  CHECK(tips.size() == 6);
}

TEST_CASE("pieces are segmented by themselves") {
  Mesh mesh = shapes::torus(40, 16, 2, 0.6);
  Mesh sphere = shapes::ellipsoid(3, 1, 1, 2);
  for (size_t i = 0; i < sphere.positions.size(); i += 3) sphere.positions[i] += 10;
  const uint32_t first = mesh.vertex_count();
  mesh.append(sphere);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  CHECK(result.graph.component_count == 2);
  CHECK(result.graph.loops() == 1);
  const std::set<uint32_t> a(result.labels.begin(), result.labels.begin() + first);
  const std::set<uint32_t> b(result.labels.begin() + first, result.labels.end());
  for (const uint32_t label : b) CHECK(a.count(label) == 0);
}

TEST_CASE("an open cylinder has two ends and no loop") {
  const Mesh mesh = shapes::open_cylinder(24, 60, 0.5, 6);
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  CHECK(result.feature_points.size() == 2);
  CHECK(result.graph.arcs.size() == 1);
  CHECK(result.graph.loops() == 0);
  // One end in the first tenth, the other in the last.
  std::set<bool> upper;
  for (const uint32_t v : result.feature_points) {
    const float z = mesh.positions[3 * v + 2];
    CHECK((z < 0.6F || z > 5.4F));
    upper.insert(z > 3);
  }
  CHECK(upper.size() == 2);
}

TEST_CASE("a seam of doubled vertices does not cut the surface") {
  // The same cylinder, closed once by shared vertices and once by a second column at the same
  // place.
  Mesh mesh = shapes::open_cylinder(24, 40, 0.5, 4);
  const Result whole = segment_mesh(mesh);
  const uint32_t count = mesh.vertex_count();
  for (uint32_t v = 0; v < count; v += 24) {
    for (uint32_t i = 0; i < 3; ++i) mesh.positions.push_back(mesh.positions[3 * v + i]);
    for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
      bool last_column = false;
      for (size_t i = t; i < t + 3; ++i) last_column |= mesh.triangles[i] % 24 == 23;
      for (size_t i = t; i < t + 3 && last_column; ++i) {
        if (mesh.triangles[i] == v) mesh.triangles[i] = mesh.vertex_count() - 1;
      }
    }
  }
  const Result seamed = segment_mesh(mesh);
  require_valid(seamed, mesh.vertex_count());
  CHECK(seamed.graph.component_count == 1);
  CHECK(std::vector(seamed.labels.begin(), seamed.labels.begin() + count) == whole.labels);
}

TEST_CASE("scaling does not change the regions") {
  Mesh mesh = shapes::implicit_surface(hand, 1.9, 48);
  const Result result = segment_mesh(mesh);
  for (float& x : mesh.positions) x *= 1024;  // exact in binary
  CHECK(segment_mesh(mesh).labels == result.labels);
  CHECK(segment_mesh(mesh).labels == segment_mesh(mesh).labels);
}

TEST_CASE("vertices without a triangle take the nearest region") {
  Mesh mesh = shapes::ellipsoid(3, 1, 1, 1);
  Mesh far = shapes::ellipsoid(3, 1, 1, 1);
  for (size_t i = 0; i < far.positions.size(); i += 3) far.positions[i] += 10;
  mesh.append(far);
  mesh.positions.insert(mesh.positions.end(), {9.F, 0.F, 0.F, 1.F, 0.5F, 0.F});
  const Result result = segment_mesh(mesh);
  require_valid(result, mesh.vertex_count());
  const size_t n = result.labels.size();
  CHECK(result.labels[n - 2] == result.labels[mesh.vertex_count() / 2 + 10]);
  CHECK(result.labels[n - 1] == result.labels[0]);
  CHECK(result.warnings.size() == 1);
}

TEST_CASE("hopeless input gives a valid partition and a warning") {
  SECTION("nothing at all") {
    const Result result = segment({}, {});
    require_valid(result, 0);
    CHECK(result.region_count == 0);
  }
  SECTION("a cloud of points") {
    const std::vector<float> points(300, 1.5F);
    const Result result = segment(points, {});
    require_valid(result, 100);
    CHECK(result.region_count == 1);
    CHECK_FALSE(result.warnings.empty());
  }
  SECTION("indices out of range, repeated, and positions that are not finite") {
    Mesh mesh = shapes::ellipsoid(2, 1, 1, 1);
    mesh.triangles.insert(mesh.triangles.end(), {0, 1, 4000000000u, 5, 5, 6});
    mesh.positions[0] = std::numeric_limits<float>::quiet_NaN();
    const Result result = segment_mesh(mesh);
    require_valid(result, mesh.vertex_count());
    CHECK_FALSE(result.warnings.empty());
  }
  SECTION("triangles without area") {
    Mesh mesh = shapes::torus(20, 10, 2, 0.5);
    for (size_t i = 0; i < mesh.positions.size(); i += 3) {
      mesh.positions[i + 1] = mesh.positions[i + 2] = 0;
    }
    require_valid(segment_mesh(mesh), mesh.vertex_count());
  }
  SECTION("all vertices at one point") {
    Mesh mesh = shapes::ellipsoid(3, 0, 0, 0);
    const Result result = segment_mesh(mesh);
    require_valid(result, mesh.vertex_count());
    CHECK(result.region_count == 1);
    Options options;
    options.weld = false;
    const Result apart = segment(mesh.positions, mesh.triangles, options);
    require_valid(apart, mesh.vertex_count());
    CHECK(apart.region_count == 1);
    CHECK_FALSE(apart.warnings.empty());
  }
  SECTION("a fan of triangles on one edge") {
    std::vector<float> positions = {0, 0, 0, 0, 0, 1};
    std::vector<uint32_t> triangles;
    for (uint32_t i = 0; i < 60; ++i) {
      const double angle = 0.1 * i;
      for (const double x : {std::cos(angle), std::sin(angle), 0.5}) {
        positions.push_back(static_cast<float>(x));
      }
      triangles.insert(triangles.end(), {0, 1, i + 2});
    }
    require_valid(segment(positions, triangles), 62);
  }
  SECTION("thousands of pieces") {
    Mesh mesh;
    for (uint32_t i = 0; i < 32000; ++i) {
      const float x = static_cast<float>(i % 200), y = static_cast<float>(i / 200);
      mesh.positions.insert(mesh.positions.end(), {x, y, 0, x + 0.5F, y, 0, x, y + 0.5F, 0});
      mesh.triangles.insert(mesh.triangles.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Result result = segment_mesh(mesh);
    require_valid(result, mesh.vertex_count());
    CHECK(result.region_count <= Options().max_regions);
    CHECK_FALSE(result.warnings.empty());
  }
}

TEST_CASE("options out of range are brought into range") {
  const Mesh mesh = shapes::ellipsoid(3, 1, 1, 2);
  Options options;
  options.eigenpairs = 0;
  options.diffusion_time = std::numeric_limits<double>::quiet_NaN();
  options.feature_persistence = -1;
  options.feature_radius = 1e9;
  options.graph_persistence = -5;
  options.max_regions = 0;
  const Result result = segment(mesh.positions, mesh.triangles, options);
  require_valid(result, mesh.vertex_count());
  CHECK(result.region_count == 1);
}

TEST_CASE("regions do not depend on the unit of length") {
  const Mesh mesh = shapes::implicit_surface(hand, 1.9, 48);
  const Result whole = segment_mesh(mesh);
  for (const int exponent : {-100, -30, -20, 20, 60}) {
    Mesh scaled = mesh;
    for (float& x : scaled.positions) x = std::ldexp(x, exponent);
    const Result result = segment_mesh(scaled);
    CHECK(result.labels == whole.labels);
    CHECK(result.scalar == whole.scalar);
    REQUIRE(result.links.size() == whole.links.size());
    for (size_t i = 0; i < whole.links.size(); ++i) {
      CHECK(result.links[i].border == std::ldexp(whole.links[i].border, exponent));
      CHECK(result.links[i].gap == std::ldexp(whole.links[i].gap, exponent));
    }
    for (size_t r = 0; r < whole.region_areas.size(); ++r)
      CHECK(result.region_areas[r] == std::ldexp(whole.region_areas[r], 2 * exponent));
  }
}
