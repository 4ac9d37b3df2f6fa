#include "codec/common/prediction/nearest.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
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
  for (const uint32_t v : order) {
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

namespace {

/// Work of a query for each vertex in turn, `order` being their coding order.
double work_of_all(const std::vector<int32_t>& xyz, const std::vector<uint32_t>& order) {
  const GridPoints points(xyz);
  std::vector<uint32_t> rank(order.size());
  for (uint32_t r = 0; r < order.size(); ++r) rank[order[r]] = r;
  EarlierNeighbours nearest(points, order, rank);
  for (const uint32_t v : order) nearest.find(v, 16);
  return static_cast<double>(nearest.work()) / static_cast<double>(order.size());
}

/// The points that a sphere of the greatest radius has on the grid: all at the same distance.
std::vector<int32_t> on_sphere(size_t count) {
  constexpr int64_t kRadius2 = int64_t{32760} * 32760 + 14 * 14 * 49;
  std::vector<int32_t> out;
  for (int64_t x = -32767; x <= 32767 && out.size() < 3 * count; x += 7) {
    for (int64_t y = -32767; y <= 32767 && out.size() < 3 * count; ++y) {
      const int64_t rest = kRadius2 - x * x - y * y;
      if (rest < 0) continue;
      const auto z = static_cast<int64_t>(std::sqrt(static_cast<double>(rest)));
      if (z * z != rest) continue;
      for (const int64_t c : {x, y, z}) out.push_back(static_cast<int32_t>(c + 32767));
    }
  }
  return out;
}

}  // namespace

TEST_CASE("no arrangement of vertices makes the search slow", "[nearest]") {
  constexpr uint32_t kCount = 8000;
  constexpr double kMaxWork = 300;  // for each vertex; a search of all would take 4000
  std::mt19937 random(3);
  std::vector<uint32_t> rising(kCount);
  std::iota(rising.begin(), rising.end(), 0u);
  std::vector<uint32_t> falling(rising.rbegin(), rising.rend());
  std::vector<uint32_t> shuffled = rising;
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  std::vector<std::vector<int32_t>> arrangements;
  arrangements.emplace_back(3 * kCount, 9);  // one place
  for (const uint32_t places : {2u, 17u, 1000u}) {
    std::vector<int32_t>& xyz = arrangements.emplace_back();
    for (uint32_t v = 0; v < kCount; ++v)
      for (uint32_t a = 0; a < 3; ++a) xyz.push_back(static_cast<int32_t>(v % places * 65));
  }
  for (const uint32_t axes : {1u, 2u, 3u}) {  // a line, a plane, a cube of random points
    std::vector<int32_t>& xyz = arrangements.emplace_back();
    for (uint32_t v = 0; v < kCount; ++v)
      for (uint32_t a = 0; a < 3; ++a)
        xyz.push_back(a < axes ? static_cast<int32_t>(random() % 65536) : 0);
  }
  std::vector<int32_t>& sphere = arrangements.emplace_back(on_sphere(kCount / 2));
  REQUIRE(sphere.size() > 3 * 100);
  while (sphere.size() < 3 * kCount) sphere.push_back(32767);  // the others at its centre
  for (size_t i = 0; i < arrangements.size(); ++i) {
    for (const auto& order : {rising, falling, shuffled}) {
      INFO("arrangement " << i << ", from " << order[0]);
      CHECK(work_of_all(arrangements[i], order) < kMaxWork);
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
