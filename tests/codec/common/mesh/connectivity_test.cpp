#include "codec/common/mesh/connectivity.h"

#include <catch2/catch.hpp>
#include <random>

using namespace reeb;
using List = std::vector<uint32_t>;

namespace {

// Marks the half-edges of the edge a-b.
void mark(const List& triangles, uint32_t a, uint32_t b, std::vector<uint8_t>& diagonal) {
  for (uint32_t h = 0; h < triangles.size(); ++h) {
    const uint32_t from = triangles[h], to = triangles[next_half_edge(h)];
    if ((from == a && to == b) || (from == b && to == a)) diagonal[h] = 1;
  }
}

}  // namespace

TEST_CASE("twins run the other way along the same edge", "[connectivity]") {
  const List strip = {0, 1, 2, 2, 1, 3};
  CHECK(pair_half_edges(strip) == List{kNoTwin, 3, kNoTwin, 1, kNoTwin, kNoTwin});
  CHECK(pair_half_edges({}).empty());
}

TEST_CASE("edges of three faces or of one direction have no twins", "[connectivity]") {
  const List book = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  for (const uint32_t twin : pair_half_edges(book)) CHECK(twin == kNoTwin);
  const List wound_differently = {0, 1, 2, 0, 1, 3};
  for (const uint32_t twin : pair_half_edges(wound_differently)) CHECK(twin == kNoTwin);
}

TEST_CASE("triangles join to polygons", "[connectivity]") {
  // A hexagon as the fan of corner 0, and a triangle on its side 1-2.
  const List triangles = {0, 1, 2, 0, 2, 3, 2, 1, 6, 0, 3, 4, 0, 4, 5};
  const List twins = pair_half_edges(triangles);
  std::vector<uint8_t> diagonal(triangles.size(), 0);
  for (const uint32_t corner : {2u, 3u, 4u}) mark(triangles, 0, corner, diagonal);
  Polygons out;
  REQUIRE(join_triangles(triangles, twins, diagonal, out));
  CHECK(out.sizes == List{6, 3});
  CHECK(out.corners == List{0, 1, 2, 3, 4, 5, 2, 1, 6});
}

TEST_CASE("a ring of triangles is no polygon", "[connectivity]") {
  // All four triangles around vertex 4 of a square.
  const List triangles = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  const List twins = pair_half_edges(triangles);
  std::vector<uint8_t> diagonal(triangles.size(), 0);
  for (const uint32_t corner : {0u, 1u, 2u, 3u}) mark(triangles, 4, corner, diagonal);
  Polygons out;
  CHECK_FALSE(join_triangles(triangles, twins, diagonal, out));
}

TEST_CASE("a closed surface of diagonals is no polygon", "[connectivity]") {
  const List triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  const List twins = pair_half_edges(triangles);
  const std::vector<uint8_t> diagonal(triangles.size(), 1);
  Polygons out;
  CHECK_FALSE(join_triangles(triangles, twins, diagonal, out));
}

TEST_CASE("twins of any triangles are those that the definition gives", "[connectivity]") {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    const auto vertices = static_cast<uint32_t>(3 + random() % 9);
    List triangles;  // some with two equal corners
    for (uint32_t i = 0; i < 3 * (random() % 12); ++i)
      triangles.push_back(static_cast<uint32_t>(random() % vertices));
    triangles.resize(triangles.size() / 3 * 3);
    const List twins = pair_half_edges(triangles);
    REQUIRE(twins.size() == triangles.size());
    for (uint32_t h = 0; h < triangles.size(); ++h) {
      const uint32_t a = triangles[h], b = triangles[next_half_edge(h)];
      List others;  // along the same edge
      for (uint32_t k = 0; k < triangles.size(); ++k) {
        const uint32_t c = triangles[k], d = triangles[next_half_edge(k)];
        if (k != h && ((a == c && b == d) || (a == d && b == c))) others.push_back(k);
      }
      const bool paired = a != b && others.size() == 1 && triangles[others[0]] == b;
      REQUIRE(twins[h] == (paired ? others[0] : kNoTwin));
    }
  }
}
