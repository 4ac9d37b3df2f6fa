#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "codec/common/attributes/mirror_sites.h"
#include "tests/codec/attributes/samples.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

constexpr int kMiddle = 3000;

SiteMesh sites_of(const Shape& shape) {
  std::vector<int32_t> grid;
  for (const float x : shape.positions)
    grid.push_back(kMiddle + static_cast<int32_t>(std::lround(100 * x)));
  return vertex_sites({shape.connectivity, grid});
}

uint32_t other_side(uint32_t v, uint32_t half) {
  const uint32_t columns = 2 * half + 1;
  return v / columns * columns + 2 * half - v % columns;
}

int64_t distance(const SiteMesh& sites, uint32_t site, const std::array<int64_t, 3>& point) {
  int64_t out = 0;
  for (size_t i = 0; i < 3; ++i) {
    const int64_t d = sites.grid[3 * size_t{site} + i] - point[i];
    out += d * d;
  }
  return out;
}

}  // namespace

TEST_CASE("the halves of a butterfly mirror each other", "[attributes]") {
  constexpr uint32_t kHalf = 5, kRows = 6;
  const Shape shape = butterfly(kHalf, kRows);
  const SiteMesh sites = sites_of(shape);
  const MirrorSites pairs(sites, {0, 2 * kMiddle});
  for (uint32_t v = 0; v < sites.count; ++v) CHECK(pairs.partner(v) == other_side(v, kHalf));
  CHECK(pairs.mirrored_triangles() == sites.triangles.size() / 3);
  std::array<uint32_t, 3> mirrored{};
  for (size_t c = 0; c < sites.triangles.size(); c += 3) {
    const auto* t = &sites.triangles[c];
    REQUIRE(pairs.find({t[1], t[2], t[0]}, mirrored));
    CHECK(mirrored == std::array<uint32_t, 3>{other_side(t[1], kHalf), other_side(t[2], kHalf),
                                              other_side(t[0], kHalf)});
  }
  CHECK_FALSE(pairs.find({0, 1, 2}, mirrored));  // in a row
  CHECK(MirrorSites(sites, {1, 0}).mirrored_triangles() == 0);
}

TEST_CASE("a partner is the nearest of all", "[attributes]") {
  std::mt19937 random(11);
  std::uniform_int_distribution<int32_t> pick(0, 400);
  SiteMesh sites;
  sites.count = 900;  // cells are 400 / 30 wide
  for (uint32_t i = 0; i < 3 * sites.count; ++i) sites.grid.push_back(pick(random));
  const MirrorSites pairs(sites, {2, 380});
  size_t near = 0;
  for (uint32_t v = 0; v < sites.count; ++v) {
    const std::array<int64_t, 3> point = {sites.grid[3 * v], sites.grid[3 * v + 1],
                                          380 - sites.grid[3 * v + 2]};
    uint32_t best = 0;
    for (uint32_t w = 1; w < sites.count; ++w) {
      if (distance(sites, w, point) < distance(sites, best, point)) best = w;
    }
    if (distance(sites, best, point) > 13 * 13) continue;  // may be cells away
    ++near;
    REQUIRE(pairs.partner(v) != MirrorSites::kNone);
    CHECK(distance(sites, pairs.partner(v), point) == distance(sites, best, point));
  }
  CHECK(near > 100);
}

TEST_CASE("sites that are all at one place are paired in no time", "[attributes]") {
  SiteMesh sites;
  sites.count = 1u << 18;
  sites.grid.assign(3 * size_t{sites.count}, 7);
  const MirrorSites pairs(sites, {0, 14});
  CHECK(pairs.partner(5) == 0);
  CHECK(pairs.partner(sites.count - 1) == 0);
}

TEST_CASE("what the halves of a body share is coded once", "[attributes]") {
  constexpr uint32_t kHalf = 9, kRows = 16;
  const Shape shape = butterfly(kHalf, kRows);
  Shot shot{shape.connectivity, 1, shape.positions, {}};
  std::mt19937 random(3);
  std::uniform_int_distribution<int> pick(0, 255);
  std::vector<uint8_t> colours(shape.connectivity.vertex_count);
  for (uint8_t& c : colours) c = static_cast<uint8_t>(pick(random));
  const auto cost = [&](const std::vector<uint8_t>& values) {
    shot.attributes.clear();
    const size_t bare = encode_or_fail(sequence_of({shot}), quick_options()).bytes.size();
    shot.attributes = {make("c", Domain::kVertex, ValueType::kU8, 1, values)};
    const Bytes bytes = encode_or_fail(sequence_of({shot}), quick_options()).bytes;
    CHECK(decode_or_fail(bytes).shots[0].attributes[0].values == values);
    return bytes.size() - bare;
  };
  const size_t apart = cost(colours);
  for (uint32_t v = 0; v < colours.size(); ++v) {
    if (v % (2 * kHalf + 1) < kHalf) colours[v] = colours[other_side(v, kHalf)];
  }
  CHECK(cost(colours) < apart * 7 / 10);  // of 19 columns 10 are new
}
