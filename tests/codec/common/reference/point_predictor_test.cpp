#include "codec/common/reference/point_predictor.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "entropy/interval_coder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;
using List = std::vector<uint32_t>;

namespace {

// Bits per vertex of a height field over the grid.
template <class Height>
double bits_per_vertex(uint32_t n, Height height) {
  const List triangles = grid_triangles(n);
  const TriangleTopology topology(n * n, triangles);
  std::vector<int32_t> grid;
  for (uint32_t v = 0; v < n * n; ++v) {
    const auto x = static_cast<int32_t>(v % n * 20), y = static_cast<int32_t>(v / n * 20);
    grid.insert(grid.end(), {x, y, height(x, y)});
  }
  PointPredictor predictor(topology);
  GuessMixture guesses(PointPredictor::kKindCount, PointPredictor::kMemory);
  IntervalEncoder coder;
  for (const uint32_t p : topology.order) {
    predictor.start(p, grid);
    for (size_t axis = 0; axis < 3; ++axis) {
      const int32_t x = grid[p * 3 + axis];
      predictor.guess(axis, guesses);
      guesses.code(coder, static_cast<uint32_t>(x), 65536, predictor.likely(axis),
                   predictor.reach(axis));
      predictor.learn(axis, x);
    }
  }
  return 8.0 * static_cast<double>(coder.finish().size()) / (n * n);
}

}  // namespace

TEST_CASE("a plane costs nearly nothing, a smooth surface little", "[point_predictor]") {
  CHECK(bits_per_vertex(40, [](int32_t x, int32_t y) { return 2 * x + y; }) < 0.3);
  const double wave = bits_per_vertex(40, [](int32_t x, int32_t y) {
    return static_cast<int32_t>(std::lround(400 + 300 * std::sin(x / 150.0) * std::cos(y / 170.0)));
  });
  CHECK(wave < 4.0);  // heights span 600 steps, over 9 bits
}

TEST_CASE("weights of features are learned from exact data", "[point_predictor]") {
  FeatureWeights weights;
  for (int i = 0; i < 300; ++i) {
    const FeatureWeights::Row f = {std::sin(i * 0.7) * 50, std::cos(i * 1.3) * 50,
                                   std::sin(i * 2.1) * 50};
    weights.learn(f, 0.5 * f[0] - 0.25 * f[1] + 1.5 * f[2], 1.0);
  }
  const FeatureWeights::Row w = weights.solve();
  CHECK(w[0] == Approx(0.5).epsilon(0.01));
  CHECK(w[1] == Approx(-0.25).epsilon(0.01));
  CHECK(w[2] == Approx(1.5).epsilon(0.01));
  CHECK(FeatureWeights().solve() == FeatureWeights::Row{0, 0, 0});
}
