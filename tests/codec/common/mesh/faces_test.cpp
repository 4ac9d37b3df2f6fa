#include "codec/common/mesh/faces.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <random>

namespace reeb {

TEST_CASE("a cycle is the smallest of its rotations", "[faces]") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<uint32_t> corners(1 + random() % 9);
    for (uint32_t& c : corners) c = static_cast<uint32_t>(random() % 3);
    std::vector<uint32_t> rotated = corners, least = corners;
    for (size_t i = 0; i < corners.size(); ++i) {
      std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
      least = std::min(least, rotated);
    }
    CHECK(canonical_cycle(corners) == least);
  }
}

TEST_CASE("a polygon that meets one vertex at most of its corners is no work", "[faces]") {
  std::vector<uint32_t> corners(200000, 7);
  corners[150000] = 9;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<uint32_t> cycle = canonical_cycle(corners);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(2));
  CHECK(cycle.back() == 9);
  CHECK(std::count(cycle.begin(), cycle.end(), 7u) == 199999);
}

}  // namespace reeb
