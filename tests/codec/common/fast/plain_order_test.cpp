#include "codec/common/fast/plain_order.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;
using List = std::vector<uint32_t>;

namespace {

std::vector<uint8_t> encode(const MeshWalk& walk, List order) {
  RansEncoder coder(1);
  REQUIRE(code_plain_order(coder, walk, order));
  return coder.finish();
}

bool decode(const std::vector<uint8_t>& bytes, const MeshWalk& walk, List& order) {
  order.assign(walk.turns(), 0);
  RansDecoder coder;
  return coder.open(bytes, 1) && code_plain_order(coder, walk, order) && !coder.overrun();
}

MeshWalk walk_of(const Shape& shape) {
  return walk_mesh(shape.connectivity.vertex_count, triangles_of(shape.connectivity));
}

List identity(uint32_t count) {
  List out(count);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

bool is_permutation(List order) {
  std::sort(order.begin(), order.end());
  return order == identity(static_cast<uint32_t>(order.size()));
}

}  // namespace

TEST_CASE("orders of plain meshes come back, whatever the mesh", "[plain_order]") {
  std::mt19937 random(11);
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    const MeshWalk walk = walk_of(shape);
    List order = identity(walk.turns());
    for (int trial = 0; trial < 3; ++trial) {
      List decoded;
      REQUIRE(decode(encode(walk, order), walk, decoded));
      CHECK(decoded == order);
      std::shuffle(order.begin(), order.end(), random);
    }
  }
}

TEST_CASE("guesses of indices follow what is known", "[plain_order]") {
  // Two triangles, the second across the edge 2-1 of the first.
  const MeshWalk walk = walk_mesh(4, List{0, 1, 2, 2, 1, 3});
  IndexGuesser guesser(walk);
  const auto guesses = [&] {
    List out;
    uint32_t index = 0;
    if (!guesser.empty()) {
      for (uint32_t s = 0; guesser.find(s, index); s += s == 0 ? 2 : 1) out.push_back(index);
    }
    return out;
  };
  guesser.start(0);
  CHECK(guesser.empty());
  CHECK(guesser.likely() == 0);
  guesser.note(1);
  guesser.start(1);
  CHECK(guesses() == List{2});  // behind the one before; no triangle is known
  guesser.note(2);
  // Behind the one before, which is also a neighbour; the other one's next is taken; before it.
  guesser.start(2);
  CHECK(guesses() == List{3, 0});
  CHECK(guesser.symbol_of(0) == 2);
  CHECK(guesser.symbol_of(1) == IndexGuesser::kNone);
  guesser.note(0);
  // The parallelogram's 0 + 2 - 1 is taken, and so is what is behind 0; behind 2 is free.
  guesser.start(3);
  CHECK(guesses() == List{3});
  CHECK(guesser.likely() == 3);
}

TEST_CASE("kinds of guesses that fail come later", "[plain_order]") {
  // A strip whose indices go up by two: behind the neighbours is always wrong, the parallelogram
  // right, but all the others are there before it.
  List triangles;
  for (uint32_t i = 0; i < 40; ++i) {
    if (i % 2 == 0) triangles.insert(triangles.end(), {i, i + 1, i + 2});
    if (i % 2 == 1) triangles.insert(triangles.end(), {i + 1, i, i + 2});
  }
  const MeshWalk walk = walk_mesh(42, triangles);
  IndexGuesser guesser(walk);
  for (uint32_t turn = 0; turn < 21; ++turn) {
    guesser.start(turn);
    const uint32_t symbol = guesser.symbol_of(2 * turn);
    if (turn == 4) CHECK(symbol == 3);
    if (turn >= 16) CHECK(symbol == 0);
    guesser.note(2 * turn);
  }
}

TEST_CASE("the order of a regular mesh costs next to nothing", "[plain_order]") {
  const Shape shape = torus(120, 80);
  const MeshWalk walk = walk_of(shape);
  CHECK(encode(walk, identity(9600)).size() < 200);
  // Where it tells nothing it costs little more than log2(n!).
  List order = identity(9600);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  CHECK(static_cast<double>(encode(walk, order).size()) <
        1.12 * std::lgamma(9601) / std::log(2) / 8);
}

TEST_CASE("damaged orders are permutations or refused", "[plain_order]") {
  const Shape shape = torus(30, 20);
  const MeshWalk walk = walk_of(shape);
  List order = identity(600);
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) std::swap(order[random() % 600], order[random() % 600]);
  const std::vector<uint8_t> bytes = encode(walk, order);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<uint8_t> damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1u << random() % 8);
    List decoded;
    if (!decode(damaged, walk, decoded)) {
      ++refused;
    } else {
      REQUIRE(is_permutation(decoded));
    }
  }
  CHECK(refused > 0);
}
