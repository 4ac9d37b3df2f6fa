#include "tools/sample/sample.h"

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "tools/sample/figures.h"
#include "tools/sample/solid.h"
#include "tools/vec3.h"

namespace reeb::tools {
namespace {

Sequence made(const std::string& name, uint32_t frames) {
  Sequence sequence;
  REQUIRE(make_sample(name, frames, sequence).ok());
  REQUIRE(sequence.shots.size() == 1);
  REQUIRE(sequence.frame_count() == frames);
  REQUIRE(sequence.shots[0].positions.size() ==
          size_t{3} * frames * sequence.shots[0].connectivity.vertex_count);
  return sequence;
}

/// What the directed edges of the faces say about the surface.
struct Topology {
  size_t repeated_edges = 0;  ///< directed edges in more than one face: not an oriented manifold
  size_t boundary_edges = 0;
  size_t edges = 0;
  size_t components = 0;
};

Topology topology(const Connectivity& c) {
  std::map<std::pair<uint32_t, uint32_t>, int> directed;
  std::vector<uint32_t> parent(c.vertex_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const uint32_t* corner = c.corners.data();
  for (const uint32_t size : c.face_sizes) {
    for (uint32_t i = 0; i < size; ++i) {
      const uint32_t a = corner[i];
      const uint32_t b = corner[(i + 1) % size];
      ++directed[{a, b}];
      parent[root(a)] = root(b);
    }
    corner += size;
  }
  Topology t;
  for (const auto& [edge, count] : directed) {
    if (count > 1) ++t.repeated_edges;
    const bool boundary = directed.count({edge.second, edge.first}) == 0;
    if (boundary) ++t.boundary_edges;
    if (boundary || edge.first < edge.second) ++t.edges;
  }
  std::set<uint32_t> roots;
  for (uint32_t v = 0; v < c.vertex_count; ++v) roots.insert(root(v));
  t.components = roots.size();
  return t;
}

double signed_volume(const Connectivity& c, std::span<const float> p) {
  const auto point = [&](uint32_t v) { return Vec3{p[3 * v], p[3 * v + 1], p[3 * v + 2]}; };
  double volume = 0;
  const uint32_t* corner = c.corners.data();
  for (const uint32_t size : c.face_sizes) {
    for (uint32_t i = 2; i < size; ++i) {
      volume += dot(point(corner[0]), cross(point(corner[i - 1]), point(corner[i]))) / 6;
    }
    corner += size;
  }
  return volume;
}

uint64_t hash(const std::vector<float>& values) {
  uint64_t h = 0xcbf29ce484222325u;
  for (const float x : values) {
    h = (h ^ std::bit_cast<uint32_t>(x)) * 0x100000001b3u;
  }
  return h;
}

float largest_step(const Shot& shot) {
  float largest = 0;
  for (uint32_t t = 1; t < shot.frame_count; ++t) {
    for (size_t i = 0; i < shot.frame(t).size(); ++i) {
      largest = std::max(largest, std::abs(shot.frame(t)[i] - shot.frame(t - 1)[i]));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("the sine of the samples") {
  for (int i = -40; i <= 40; ++i) {
    const double turns = i / 16.0 + 0.003;
    CHECK(turn_sine(turns) == Approx(std::sin(turns * 2 * std::acos(-1.0))).margin(1e-12));
    CHECK(turn_cosine(turns) == Approx(std::cos(turns * 2 * std::acos(-1.0))).margin(1e-12));
  }
}

TEST_CASE("the creature is one closed surface without handles that walks") {
  const Sequence s = made("creature", 30);
  const Shot& shot = s.shots[0];
  const Topology t = topology(shot.connectivity);
  CHECK(shot.connectivity.vertex_count >= 5000);
  CHECK(t.repeated_edges == 0);
  CHECK(t.boundary_edges == 0);
  CHECK(t.components == 1);
  const auto faces = static_cast<int>(shot.connectivity.face_sizes.size());
  CHECK(static_cast<int>(shot.connectivity.vertex_count) - static_cast<int>(t.edges) + faces == 2);
  // Faces look outwards, and the volume stays about the same while it walks.
  const double volume = signed_volume(shot.connectivity, shot.frame(0));
  CHECK(volume > 0.1);
  CHECK(signed_volume(shot.connectivity, shot.frame(20)) == Approx(volume).epsilon(0.1));
  CHECK(largest_step(shot) > 0.01f);
  CHECK(largest_step(shot) < 0.2f);
}

TEST_CASE("the sheet has one boundary and moves") {
  const Sequence s = made("sheet", 40);
  const Shot& shot = s.shots[0];
  const Topology t = topology(shot.connectivity);
  CHECK(t.repeated_edges == 0);
  CHECK(t.boundary_edges == 4 * 55);
  CHECK(t.components == 1);
  CHECK(std::set<uint32_t>(shot.connectivity.face_sizes.begin(),
                           shot.connectivity.face_sizes.end()) == std::set<uint32_t>{4});
  CHECK(largest_step(shot) > 0.01f);
  CHECK(largest_step(shot) < 0.3f);
}

TEST_CASE("the parts of the mechanism are closed and rigid") {
  const Sequence s = made("mechanism", 60);
  const Shot& shot = s.shots[0];
  const Topology t = topology(shot.connectivity);
  CHECK(t.repeated_edges == 0);
  CHECK(t.boundary_edges == 0);
  CHECK(t.components == 7);
  // Edges keep their length.
  const auto edge = [&](uint32_t frame, uint32_t a, uint32_t b) {
    const auto p = shot.frame(frame);
    return length(
        Vec3{p[3 * a] - p[3 * b], p[3 * a + 1] - p[3 * b + 1], p[3 * a + 2] - p[3 * b + 2]});
  };
  const auto& corners = shot.connectivity.corners;
  for (size_t i = 0; i + 1 < 4 * 600; i += 4) {
    CHECK(edge(47, corners[i], corners[i + 1]) ==
          Approx(edge(0, corners[i], corners[i + 1])).epsilon(1e-4));
  }
  CHECK(signed_volume(shot.connectivity, shot.frame(0)) > 0);
}

TEST_CASE(
    "samples are the same to the bit every time, and a longer one begins like a shorter one") {
  for (const SampleInfo& info : samples()) {
    INFO(info.name);
    const Sequence a = made(info.name, 3);
    const Sequence b = made(info.name, 5);
    CHECK(a.frame_rate == 25);
    CHECK(
        hash(a.shots[0].positions) ==
        hash({b.shots[0].positions.begin(),
              b.shots[0].positions.begin() + static_cast<ptrdiff_t>(a.shots[0].positions.size())}));
  }
  Sequence none;
  CHECK_FALSE(make_sample("unicorn", 3, none).ok());
}

TEST_CASE("a solid is its parts, less what is carved") {
  Solid solid(1e-3);
  solid.add_cone({0, 0, 0}, {2, 0, 0}, 0.5, 0.5);
  CHECK(solid.value({1, 2, 0}) == Approx(1.5));
  CHECK(solid.value({3, 0, 0}) == Approx(0.5));
  CHECK(solid.value({1, 0, 0}) == Approx(-0.5));
  solid.carve_cone({1, 0, -9}, {1, 0, 9}, 0.2, 0.2);
  CHECK(solid.value({1, 0, 0}) == Approx(0.2));
  Solid box(1e-3);
  box.add_box(rotation(2, 0.25, {}), {2, 1, 1}, 0.1);  // a quarter turn: 2 along y now
  CHECK(box.value({0, 3, 0}) == Approx(1));
  CHECK(box.value({3, 0, 0}) == Approx(2));
}

TEST_CASE("figures are closed surfaces, alike in kind and not in shape") {
  CHECK(figure_kinds().size() >= 20);
  for (const std::string kind : {"human", "glasses", "cup"}) {
    Sequence one, again, other;
    REQUIRE(make_sample(kind + "-1", 2, one).ok());
    REQUIRE(make_sample(kind + "-1", 1, again).ok());
    REQUIRE(make_sample(kind + "-2", 1, other).ok());
    REQUIRE(one.shots.size() == 2);
    CHECK(one.shots[0].positions == again.shots[0].positions);
    CHECK(one.shots[0].positions != other.shots[0].positions);
    const Topology t = topology(one.shots[0].connectivity);
    CHECK(t.repeated_edges < t.edges / 100);  // where parts touch
    CHECK(t.boundary_edges == 0);
    CHECK(t.components == 1);
    CHECK(one.shots[0].connectivity.vertex_count > 4000);
    CHECK(one.shots[0].connectivity.vertex_count < 6000);
  }
  Sequence none;
  for (const char* name : {"human", "human-0", "human-x", "nobody-1", "human-1x", "-1"})
    CHECK_FALSE(make_sample(name, 1, none).ok());
}

}  // namespace reeb::tools
