#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <tuple>

#include "codec/common/prediction/prediction_graph.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

struct Built {
  std::string name;
  uint32_t vertices;
  SurfaceGraph surface;
};

Built build(const Shape& shape, uint32_t bits = 12) {
  const std::vector<int32_t> xyz = on_grid(shape, bits);
  return {shape.name, shape.connectivity.vertex_count,
          build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity))};
}

std::vector<Built> all_built() {
  std::vector<Built> out;
  for (const Shape& s : small_shapes()) out.push_back(build(s));
  out.push_back(build(torus(50, 30)));
  out.push_back(build(torus(50, 30), 1));
  out.push_back(build(hub(300)));
  return out;
}

}  // namespace

TEST_CASE("the order of a surface graph has every vertex once", "[surface_graph]") {
  for (const Built& b : all_built()) {
    INFO(b.name);
    REQUIRE(b.surface.graph.size() == b.vertices);
    std::vector<uint32_t> sorted = b.surface.order, all(b.vertices);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0u);
    CHECK(sorted == all);
  }
}

TEST_CASE("rows of a surface graph are predicted from earlier ones", "[surface_graph]") {
  for (const Built& b : all_built()) {
    INFO(b.name);
    for (uint32_t r = 0; r < b.vertices; ++r) {
      const PredictionGraph::Row& row = b.surface.graph.rows[r];
      REQUIRE(row.ring <= row.count);
      REQUIRE(row.count <= kMaxNeighbours);
      REQUIRE((r == 0) == (row.ring == 0));  // anything but the first has something to lean on
      const std::set<uint32_t> distinct(&row.neighbour[0], &row.neighbour[row.count]);
      REQUIRE(distinct.size() == row.count);
      if (row.count > 0) REQUIRE(*distinct.rbegin() < r);
      for (uint32_t i = row.count; i < kMaxNeighbours; ++i) {
        REQUIRE(row.neighbour[i] == r);
        REQUIRE(row.prior[i] == 0.0f);
      }
    }
  }
}

TEST_CASE("priors are weights of a mean over the ring", "[surface_graph]") {
  for (const Built& b : all_built()) {
    INFO(b.name);
    for (const PredictionGraph::Row& row : b.surface.graph.rows) {
      if (row.ring == 0) continue;
      double sum = 0;
      for (uint32_t i = 0; i < row.ring; ++i) {
        REQUIRE(row.prior[i] >= 0.0f);
        sum += static_cast<double>(row.prior[i]);
      }
      // Each is rounded down to 1/65536.
      REQUIRE(sum <= 1.0);
      REQUIRE(sum > 1.0 - (row.ring + 1) / 65536.0);
      for (uint32_t i = row.ring; i < kMaxNeighbours; ++i) REQUIRE(row.prior[i] == 0.0f);
    }
  }
}

TEST_CASE("uses are the neighbours seen from the other side", "[surface_graph]") {
  for (const Built& b : all_built()) {
    INFO(b.name);
    const PredictionGraph& g = b.surface.graph;
    const RowUses uses = find_uses(g);
    std::multiset<std::tuple<uint32_t, uint32_t, bool>> expected, found;
    for (uint32_t r = 0; r < g.size(); ++r) {
      for (uint32_t i = 0; i < g.rows[r].count; ++i)
        expected.emplace(g.rows[r].neighbour[i], r, i < g.rows[r].ring);
      for (const uint32_t use : uses[r]) found.emplace(r, use / 2, use % 2 != 0);
    }
    CHECK(found == expected);
  }
}

TEST_CASE("rows that predict more have finer steps", "[surface_graph]") {
  const Built b = build(torus(50, 30));
  const PredictionGraph& g = b.surface.graph;
  CHECK(kStepTable[0] == 65536);
  CHECK(std::is_sorted(kStepTable.rbegin(), kStepTable.rend()));
  CHECK(kStepTable.back() > 0);
  std::vector<bool> predicts(g.size(), false);
  for (const PredictionGraph::Row& row : g.rows) {
    for (uint32_t i = 0; i < row.ring; ++i) predicts[row.neighbour[i]] = true;
  }
  for (uint32_t r = 0; r < g.size(); ++r) {
    REQUIRE(g.step_index[r] < kStepSizes);
    if (!predicts[r]) REQUIRE(g.step_index[r] == 0);
  }
  CHECK(g.step_index[0] > g.step_index[g.size() / 2]);
}

TEST_CASE("the first rows lie all over the mesh", "[surface_graph]") {
  const Shape shape = torus(50, 30);
  const Built b = build(shape);
  bool side[2] = {false, false};
  for (uint32_t r = 0; r < 20; ++r) side[shape.positions[b.surface.order[r] * 3] > 0] = true;
  CHECK((side[0] && side[1]));
}

TEST_CASE("no vertices make an empty graph", "[surface_graph]") {
  CHECK(build_surface_graph(GridPoints({}), {}).graph.size() == 0);
}
