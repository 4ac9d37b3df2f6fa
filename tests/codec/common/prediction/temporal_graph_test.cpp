#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "codec/common/prediction/prediction_graph.h"

using namespace reeb;

namespace {

const std::vector<uint32_t> kLengths = {1, 2, 3, 4, 5, 8, 9, 17, 31, 40, 64, 100, 257};

double time_of(const TemporalGraph& g, uint32_t row) { return g.order[row] / 3; }

/// What the priors make of the polynomial t^power at a row.
double predicted(const TemporalGraph& g, const PredictionGraph::Row& row, int power) {
  double sum = 0;
  for (uint32_t i = 0; i < row.ring; ++i)
    sum += static_cast<double>(row.prior[i]) * std::pow(time_of(g, row.neighbour[i]), power);
  return sum;
}

}  // namespace

TEST_CASE("a temporal graph has every time and axis once", "[temporal_graph]") {
  for (const uint32_t frames : kLengths) {
    const TemporalGraph g = build_temporal_graph(frames);
    REQUIRE(g.order.size() == 3 * frames);
    REQUIRE(g.graph.size() == 3 * frames);
    std::vector<uint32_t> sorted = g.order;
    std::sort(sorted.begin(), sorted.end());
    for (uint32_t i = 0; i < sorted.size(); ++i) REQUIRE(sorted[i] == i);
  }
}

TEST_CASE("rows of a temporal graph are predicted from earlier ones", "[temporal_graph]") {
  for (const uint32_t frames : kLengths) {
    const TemporalGraph g = build_temporal_graph(frames);
    for (uint32_t r = 0; r < g.graph.size(); ++r) {
      const PredictionGraph::Row& row = g.graph.rows[r];
      const std::set<uint32_t> distinct(&row.neighbour[0], &row.neighbour[row.count]);
      REQUIRE(distinct.size() == row.count);
      if (row.count > 0) REQUIRE(*distinct.rbegin() < r);
      for (uint32_t i = 0; i < row.ring; ++i)
        REQUIRE(g.order[row.neighbour[i]] % 3 == g.order[r] % 3);  // the same axis
      for (uint32_t i = row.count; i < kMaxNeighbours; ++i) {
        REQUIRE(row.neighbour[i] == r);
        REQUIRE(row.prior[i] == 0.0f);
      }
    }
  }
}

TEST_CASE("motions of constant velocity are interpolated exactly", "[temporal_graph]") {
  for (const uint32_t frames : kLengths) {
    const TemporalGraph g = build_temporal_graph(frames);
    for (uint32_t r = 0; r < g.graph.size(); ++r) {
      const PredictionGraph::Row& row = g.graph.rows[r];
      if (row.ring == 0) continue;
      REQUIRE(predicted(g, row, 0) == Approx(1));
      if (row.ring >= 2) REQUIRE(predicted(g, row, 1) == Approx(time_of(g, r)));
    }
  }
}

TEST_CASE("cubic motions are interpolated exactly in the middle", "[temporal_graph]") {
  const TemporalGraph g = build_temporal_graph(100);
  uint32_t cubic = 0;
  for (uint32_t r = 0; r < g.graph.size(); ++r) {
    const PredictionGraph::Row& row = g.graph.rows[r];
    if (row.ring < 4) continue;
    ++cubic;
    for (int power = 2; power <= 3; ++power)
      REQUIRE(predicted(g, row, power) == Approx(std::pow(time_of(g, r), power)));
  }
  CHECK(cubic > 200);  // of 300 rows
}
