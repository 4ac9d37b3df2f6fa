#include "codec/common/prediction/nearest.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace reeb;

namespace {

std::vector<uint32_t> brute_force(const GridPoints& points, const std::vector<uint32_t>& rank,
                                  uint32_t v, uint32_t k) {
  std::vector<std::pair<uint64_t, uint32_t>> all;
  for (uint32_t u = 0; u < points.size(); ++u) {
    if (rank[u] < rank[v]) all.emplace_back(points.distance2(v, u), u);
  }
  std::sort(all.begin(), all.end());
  std::vector<uint32_t> out;
  for (size_t i = 0; i < std::min<size_t>(k, all.size()); ++i) out.push_back(all[i].second);
  return out;
}

void check(const std::vector<int32_t>& xyz, std::mt19937& random) {
  const GridPoints points(xyz);
  std::vector<uint32_t> rank(points.size());
  std::iota(rank.begin(), rank.end(), 0u);
  std::shuffle(rank.begin(), rank.end(), random);
  std::vector<uint32_t> order(rank.size());
  for (uint32_t v = 0; v < rank.size(); ++v) order[rank[v]] = v;
  EarlierNeighbours nearest(points, order, rank);
  for (uint32_t v = 0; v < points.size(); ++v) {
    for (const uint32_t k : {1u, 5u, 16u})
      REQUIRE(nearest.find(v, k) == brute_force(points, rank, v, k));
  }
}

}  // namespace

TEST_CASE("nearest earlier vertices are those of a full search", "[nearest]") {
  std::mt19937 random(1);
  for (const uint32_t range : {65536u, 300u, 4u, 1u}) {  // the last ones full of ties
    for (const size_t count : {1u, 2u, 9u, 17u, 100u, 600u}) {
      std::vector<int32_t> xyz(3 * count);
      for (int32_t& x : xyz) x = static_cast<int32_t>(random() % range);
      check(xyz, random);
    }
  }
}

TEST_CASE("nearest earlier vertices on a line and at the far corners", "[nearest]") {
  std::mt19937 random(2);
  std::vector<int32_t> line, corners;
  for (int32_t i = 0; i < 300; ++i) {
    line.insert(line.end(), {7, i * 218, 7});
    for (int a = 0; a < 3; ++a) corners.push_back((i >> a & 1) * 65535);
  }
  check(line, random);
  check(corners, random);
}
