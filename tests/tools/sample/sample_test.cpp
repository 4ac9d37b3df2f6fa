#include "tools/sample/sample.h"

#include <algorithm>
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

Shot attributed(const std::string& name) {
  Sequence sequence;
  REQUIRE(make_sample(name, 3, sequence, true).ok());
  CHECK(sequence.shots[0].positions == made(name, 3).shots[0].positions);
  return sequence.shots[0];
}

Vec3 normal_of(const Shot& shot, uint32_t frame, size_t triangle) {
  const auto at = [&](size_t corner) {
    const float* p =
        &shot.frame(frame)[size_t{3} * shot.connectivity.corners[3 * triangle + corner]];
    return Vec3{p[0], p[1], p[2]};
  };
  return normalized(cross(at(1) - at(0), at(2) - at(0)));
}

}  // namespace

TEST_CASE("samples have no attributes unless asked for") {
  for (const char* name : {"creature", "sheet", "mechanism"})
    CHECK(made(name, 2).shots[0].attributes.empty());
}

TEST_CASE("the creature has a texture with seams, and claws of another material") {
  const Shot shot = attributed("creature");
  REQUIRE(shot.attributes.size() == 3);
  const Attribute &vt = shot.attributes[0], &vn = shot.attributes[1], &usemtl = shot.attributes[2];
  const size_t triangles = shot.connectivity.face_sizes.size(), corners = 3 * triangles;
  CHECK(usemtl.names == std::vector<std::string>{"skin", "claw"});
  // Within a texture's square; at a seam one vertex has several places in it.
  std::map<uint32_t, std::set<std::pair<float, float>>> places;
  for (size_t c = 0; c < corners; ++c) {
    const float u = vt.get<float>(2 * c), v = vt.get<float>(2 * c + 1);
    CHECK((u >= 0 && u <= 1 && v >= 0 && v <= 1));
    places[shot.connectivity.corners[c]].insert({u, v});
  }
  const auto seams = std::count_if(places.begin(), places.end(),
                                   [](const auto& place) { return place.second.size() > 1; });
  CHECK(seams > 100);
  CHECK(seams < static_cast<std::ptrdiff_t>(places.size()) / 3);
  // Claws have the normals of their triangles in every frame, skin those of its surroundings.
  size_t claws = 0, turned = 0;
  for (uint32_t f = 0; f < 3; ++f) {
    for (size_t t = 0; t < triangles; ++t) {
      const Vec3 own = normal_of(shot, f, t);
      for (size_t c = 0; c < 3; ++c) {
        const size_t at = 3 * (f * corners + 3 * t + c);
        const Vec3 n{vn.get<float>(at), vn.get<float>(at + 1), vn.get<float>(at + 2)};
        CHECK(dot(n, n) == Approx(1).margin(1e-5));
        if (usemtl.get<int32_t>(t) == 1) {
          CHECK(dot(n, own) == Approx(1).margin(1e-4));
        } else {
          turned += dot(n, own) < 0.9999;
        }
      }
      claws += f == 0 && usemtl.get<int32_t>(t) == 1;
    }
  }
  CHECK(claws > 20);
  CHECK(claws < triangles / 10);
  CHECK(turned > corners);
}

TEST_CASE("the sheet tells how far its threads are stretched") {
  const Shot shot = attributed("sheet");
  REQUIRE(shot.attributes.size() == 1);
  const Attribute& stretch = shot.attributes[0];
  CHECK(stretch.animated);
  // Hung to 0.93 of its width, in waves of 0.03 m whose steps are at most 0.0085 m for 0.036: each
  // thread across is 0.930 to 0.959 of its length, those down have theirs, and a vertex has two of
  // each; at the border one may be missing.
  for (size_t i = 0; i < shot.connectivity.vertex_count; ++i) {
    CHECK(stretch.get<float>(i) > -0.0468f);
    CHECK(stretch.get<float>(i) < -0.0136f);
  }
  CHECK(stretch.get<float>(0) != stretch.get<float>(size_t{2} * shot.connectivity.vertex_count));
}

TEST_CASE("each part of the mechanism is a group of one colour") {
  const Shot shot = attributed("mechanism");
  REQUIRE(shot.attributes.size() == 2);
  const Attribute &colour = shot.attributes[0], &group = shot.attributes[1];
  std::map<int32_t, std::set<std::array<float, 3>>> colours;
  size_t corner = 0;
  for (size_t f = 0; f < shot.connectivity.face_sizes.size(); ++f) {
    for (uint32_t i = 0; i < shot.connectivity.face_sizes[f]; ++i, ++corner) {
      const size_t v = size_t{3} * shot.connectivity.corners[corner];
      colours[group.get<int32_t>(f)].insert(
          {colour.get<float>(v), colour.get<float>(v + 1), colour.get<float>(v + 2)});
    }
  }
  CHECK(colours.size() == topology(shot.connectivity).components);
  CHECK(colours.size() == group.names.size());
  for (const auto& [part, of_part] : colours) CHECK(of_part.size() == 1);
}

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
