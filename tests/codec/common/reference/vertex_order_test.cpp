#include "codec/common/reference/vertex_order.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "entropy/interval_coder.h"

using namespace reeb;

namespace {

std::vector<uint32_t> code_order(const std::vector<uint32_t>& order,
                                 const std::vector<uint32_t>& triangles, double& bits) {
  std::vector<uint32_t> copy = order;
  const auto n = static_cast<uint32_t>(order.size());
  IntervalEncoder encoder;
  REQUIRE(code_vertex_order(encoder, TriangleTopology(n, triangles), copy).ok());
  const std::vector<uint8_t> bytes = encoder.finish();
  bits = 8.0 * static_cast<double>(bytes.size());
  IntervalDecoder decoder(bytes);
  std::vector<uint32_t> decoded;
  REQUIRE(code_vertex_order(decoder, TriangleTopology(n, triangles), decoded).ok());
  return decoded;
}

// log2(n!).
double random_bits(size_t n) { return std::lgamma(static_cast<double>(n) + 1) / std::log(2.0); }

// Triangles of a strip 0 1 2, 2 1 3, ... renamed by `name`.
std::vector<uint32_t> strip(const std::vector<uint32_t>& name) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i + 2 < name.size(); ++i) {
    const bool odd = i % 2 != 0;
    out.insert(out.end(), {name[i], name[odd ? i + 2 : i + 1], name[odd ? i + 1 : i + 2]});
  }
  return out;
}

std::vector<uint32_t> shuffled(uint32_t n, uint32_t seed) {
  std::vector<uint32_t> out(n);
  std::iota(out.begin(), out.end(), 0u);
  std::shuffle(out.begin(), out.end(), std::mt19937(seed));
  return out;
}

}  // namespace

TEST_CASE("free indices agree with counting", "[vertex_order]") {
  constexpr uint32_t kCount = 37;
  FreeIndices free(kCount);
  std::vector<uint32_t> left(kCount);
  std::iota(left.begin(), left.end(), 0u);
  std::mt19937 random(1);
  while (!left.empty()) {
    REQUIRE(free.count() == left.size());
    for (uint32_t i = 0; i < kCount; ++i) {
      const auto below = std::lower_bound(left.begin(), left.end(), i) - left.begin();
      REQUIRE(free.rank(i) == below);
    }
    for (uint32_t r = 0; r < left.size(); ++r) REQUIRE(free.select(r) == left[r]);
    const size_t gone = random() % left.size();
    free.take(left[gone]);
    left.erase(left.begin() + static_cast<long>(gone));
  }
}

TEST_CASE("any permutation comes back", "[vertex_order]") {
  double bits = 0;
  for (const uint32_t n : {1u, 2u, 3u, 17u, 500u}) {
    const auto order = shuffled(n, n);
    CHECK(code_order(order, {}, bits) == order);
    CHECK(code_order(order, strip(shuffled(n, 99)), bits) == order);
  }
}

TEST_CASE("a random order costs little more than its entropy", "[vertex_order]") {
  double bits = 0;
  const auto order = shuffled(3000, 8);
  CHECK(code_order(order, {}, bits) == order);
  CHECK(bits < 1.03 * random_bits(3000));
}

TEST_CASE("the identity costs next to nothing", "[vertex_order]") {
  double bits = 0;
  std::vector<uint32_t> order(3000);
  std::iota(order.begin(), order.end(), 0u);
  CHECK(code_order(order, {}, bits) == order);
  CHECK(bits < 0.01 * random_bits(3000));
}

TEST_CASE("an order along the mesh is cheap in any coding order", "[vertex_order]") {
  double bits = 0;
  const uint32_t n = 3000;
  const auto order = shuffled(n, 8);
  // Coding vertex v has index order[v], and the strip runs along the indices.
  std::vector<uint32_t> coding_of(n);
  for (uint32_t v = 0; v < n; ++v) coding_of[order[v]] = v;
  CHECK(code_order(order, strip(coding_of), bits) == order);
  CHECK(bits < 0.6 * random_bits(n));
}

TEST_CASE("an order that is cut off is an error or a permutation", "[vertex_order]") {
  const auto order = shuffled(300, 8);
  std::vector<uint32_t> copy = order;
  IntervalEncoder encoder;
  REQUIRE(code_vertex_order(encoder, TriangleTopology(300, {}), copy).ok());
  const std::vector<uint8_t> bytes = encoder.finish();
  const std::span<const uint8_t> half(bytes.data(), bytes.size() / 2);
  IntervalDecoder decoder(half);
  std::vector<uint32_t> decoded;
  CHECK(code_vertex_order(decoder, TriangleTopology(300, {}), decoded).code() ==
        StatusCode::kCorrupt);
}
