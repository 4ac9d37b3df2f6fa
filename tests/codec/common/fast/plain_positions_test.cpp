#include "codec/common/fast/plain_positions.h"

#include <catch2/catch.hpp>
#include <random>

#include "entropy/rans.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

std::vector<uint8_t> encode(const MeshWalk& walk, std::vector<int32_t> grid) {
  RansEncoder coder(3);
  REQUIRE(code_plain_positions(coder, walk, grid));
  return coder.finish();
}

bool decode(const std::vector<uint8_t>& bytes, const MeshWalk& walk, std::vector<int32_t>& grid) {
  grid.assign(size_t{walk.turns()} * 3, 0);
  RansDecoder coder;
  return coder.open(bytes, 3) && code_plain_positions(coder, walk, grid) && !coder.overrun();
}

MeshWalk walk_of(const Shape& shape) {
  return walk_mesh(shape.connectivity.vertex_count, triangles_of(shape.connectivity));
}

}  // namespace

TEST_CASE("positions of plain meshes come back, whatever the mesh", "[plain_positions]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    const MeshWalk walk = walk_of(shape);
    const std::vector<int32_t> grid = on_grid(shape, 16);
    std::vector<int32_t> decoded;
    REQUIRE(decode(encode(walk, grid), walk, decoded));
    CHECK(decoded == grid);
  }
}

TEST_CASE("plain positions go by the means of parallelograms and edges", "[plain_positions]") {
  // 3 lies across the edge 1-2 of the triangle before; 4 in the middle of two tips.
  const std::vector<uint32_t> triangles = {0, 1, 2, 2, 1, 3, 2, 3, 4};
  const MeshWalk walk = walk_mesh(5, triangles);
  PlainPositions positions(walk);
  const auto place = [&](uint32_t turn) { return positions.guess(turn).place; };
  const auto cls = [&](uint32_t turn) { return positions.guess(turn).cls[0]; };
  const auto note = [&](uint32_t turn, int32_t x, int32_t y, int32_t missed) {
    positions.note(turn, {x, y, 0, 0}, {missed, 0, 0, 0});
  };
  CHECK(place(0) == PlainPositions::Point{0, 0, 0, 0});
  CHECK(cls(0) == 0);
  note(0, 100, 100, 8);
  CHECK(place(1) == PlainPositions::Point{100, 100, 0, 0});  // the one before
  // 8 * 32 / 16 = 16 expected (in 1/16), twice that where nothing is known: 33 = 100001b.
  CHECK(cls(1) == 2 * 5 + 0);
  note(1, 201, 100, 0);
  CHECK(place(2) == PlainPositions::Point{150, 100, 0, 0});  // 150.5, to even
  note(2, 150, 200, 0);
  CHECK(place(3) == PlainPositions::Point{251, 200, 0, 0});
  note(3, 250, 201, -1);
  CHECK(place(4) == PlainPositions::Point{199, 301, 0, 0});
}

TEST_CASE("positions of a regular surface cost little", "[plain_positions]") {
  const Shape shape = torus(120, 80);
  const MeshWalk walk = walk_of(shape);
  const double bits = 8.0 * static_cast<double>(encode(walk, on_grid(shape, 12)).size()) / 9600;
  CHECK(bits < 7.5);
}

TEST_CASE("damaged positions stay on the grid or are refused", "[plain_positions]") {
  const Shape shape = torus(30, 20);
  const MeshWalk walk = walk_of(shape);
  const std::vector<uint8_t> bytes = encode(walk, on_grid(shape, 16));
  std::mt19937 random(3);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<uint8_t> damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1u << random() % 8);
    std::vector<int32_t> grid;
    if (!decode(damaged, walk, grid)) {
      ++refused;
      continue;
    }
    for (const int32_t x : grid) REQUIRE((x >= 0 && x <= kGridMax));
  }
  CHECK(refused > 0);
}
