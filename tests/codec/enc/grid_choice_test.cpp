#include "codec/enc/lossless/grid_choice.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

/// True where the grid has every value among its levels.
bool holds(const FrameGrid& grid, const std::vector<float>& values) {
  const NumberSet set = NumberSet::levels(grid);
  for (const float x : values) {
    bool found = false;
    set.find(x, found);
    if (!found) return false;
  }
  return true;
}

/// Levels as readers of MD2 files compute them: product and sum each rounded to binary32.
std::vector<float> md2_values(float step, float origin, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> out;
  for (int i = 0; i < 300; ++i) {
    const float scaled = static_cast<float>(random() % 256) * step;
    out.push_back(scaled + origin);
  }
  return out;
}

}  // namespace

TEST_CASE("a grid is found through rounding", "[grid_choice]") {
  for (uint32_t seed = 1; seed < 20; ++seed) {
    const float step = 0.0137f * static_cast<float>(seed), origin = 3.0f - static_cast<float>(seed);
    const std::vector<float> values = md2_values(step, origin, seed);
    const FrameGrid grid = find_grid(values);
    INFO(seed);
    CHECK(grid.count <= 256);
    CHECK(grid.count > 200);
    CHECK(grid.step == Approx(step).epsilon(1e-4));
    CHECK(holds(grid, values));
  }
}

TEST_CASE("a grid is found whose least distance is more than a step", "[grid_choice]") {
  const std::vector<float> values{0.0f, 2 * 0.25f, 5 * 0.25f, 9 * 0.25f};
  const FrameGrid grid = find_grid(values);
  CHECK(grid.step == Approx(0.25));
  CHECK(grid.count == 10);
  CHECK(grid.corrections.empty());
}

TEST_CASE("numbers of any kind lie on no grid, single ones on one", "[grid_choice]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-1, 1);
  std::vector<float> values(500);
  for (float& x : values) x = any(random);
  CHECK(find_grid(values).count == 0);
  for (const float x : {0.0f, -2.5f, 3e38f, 1e-45f}) {
    const FrameGrid grid = find_grid({x, x});
    if (grid.count == 0) continue;  // too small for a step
    CHECK(grid.count == 1);
    CHECK(NumberSet::levels(grid).number(0) == x);
  }
}

TEST_CASE("levels are numbered, corrected and bounded", "[grid_choice]") {
  FrameGrid grid{.count = 4, .origin = 1, .step = 0.5, .corrections = {{2, 3}, {3, -1}}};
  const NumberSet set = NumberSet::levels(grid);
  const auto up = [](float x, int places) {
    for (; places > 0; --places) x = std::nextafter(x, 10.0f);
    for (; places < 0; ++places) x = std::nextafter(x, -10.0f);
    return x;
  };
  CHECK(set.number(0) == 1);
  CHECK(set.number(1) == 1.5f);
  CHECK(set.number(2) == up(2, 3));
  CHECK(set.number(3) == up(2.5f, -1));
  CHECK_FALSE(set.valid(-1));
  CHECK(set.valid(3));
  CHECK_FALSE(set.valid(4));
  CHECK(set.nearest(1.2) == 0);
  CHECK(set.nearest(1.25) == 1);
  CHECK(set.nearest(-1e300) == 0);
  CHECK(set.nearest(1e300) == 3);
  // Levels follow each other in a ring.
  CHECK(set.difference(0, 3) == -1);
  CHECK(set.difference(3, 1) == -2);
  CHECK(set.moved(3, 2) == 1);
  CHECK(set.moved(1, -6) == 3);
  bool found = true;
  set.find(2.0f, found);
  CHECK_FALSE(found);
  // An octave is 8, and numbers of binary32 that lie as far apart say the same.
  grid.step = 1;
  CHECK(NumberSet::levels(grid).spacing(0) == set.spacing(0) + 8);
  const NumberSet all;
  CHECK(NumberSet::levels(grid).spacing(0) == all.spacing(all.nearest(0x1p23)));
}
