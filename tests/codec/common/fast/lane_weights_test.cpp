#include "codec/common/fast/lane_weights.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "codec/common/fast/contraction.h"
#include "codec/common/fast/lane_field.h"
#include "codec/common/simd/instruction_set.h"
#include "codec/enc/fields/lane_field_encoder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// A surface and 24 planes on it, as two blocks hold them.
struct Fixture {
  std::vector<int32_t> xyz;
  SurfaceGraph surface;
  LaneStart start;
  std::vector<float> first, second;
  std::vector<float> narrow;  ///< the first block as it is kept

  explicit Fixture(const Shape& shape, float size = 9)
      : xyz(on_grid(shape, 12)),
        surface(contract_mesh(shape.connectivity.vertex_count, triangles_of(shape.connectivity))) {
    weigh_rows(GridPoints(xyz), surface);
    start = lane_start(surface, GridPoints(xyz));
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    for (const uint32_t v : surface.order) {
      const float* p = &shape.positions[size_t{v} * 3];
      for (uint32_t l = 0; l < kRansLanes; ++l) {
        const auto lane = static_cast<float>(l);
        first.push_back(l < 8 ? size * (std::sin(p[0] + lane) + 0.1f * normal(random)) : 0.0f);
        second.push_back(size * (std::cos(p[1] - lane) + 0.1f * normal(random)));
        if (l < kFirstLanes) narrow.push_back(first.back());
      }
    }
  }

  uint32_t rows() const { return surface.graph.size(); }
  LaneWeightTask task(uint32_t blocks) const {
    LaneWeightTask out = {surface.graph.rows.data(), start.points.data()};
    if (blocks > 0) out.values = blocks == 1 ? first.data() : second.data();
    if (blocks == 2) out.first_values = narrow.data();
    return out;
  }
  /// Value of plane k in a row.
  double value(uint32_t k, uint32_t row) const {
    const std::vector<float>& block = k < 8 ? first : second;
    return static_cast<double>(block[size_t{row} * kRansLanes + (k < 8 ? k : k - 8)]);
  }
};

std::vector<float> learn_all(const LaneWeightTask& task, uint32_t rows) {
  std::vector<float> out(size_t{rows} * kMaxNeighbours);
  std::vector<uint32_t> all;
  for (uint32_t r = 0; r < rows; ++r) all.push_back(r);
  learn_weights(task, all, out);
  return out;
}

/// Minimum of what spec/fast.md says, by one dense system with a multiplier for the sum.
Eigen::VectorXd best_weights(const Fixture& f, uint32_t r, uint32_t planes, double share = 0.125) {
  const PredictionGraph::Row& row = f.surface.graph.rows[r];
  const Eigen::Index n = row.count;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, n + 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 1);
  Eigen::MatrixXd points(n, 3), values(n, planes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const uint32_t neighbour = row.neighbour[static_cast<size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      points(i, axis) = f.xyz[size_t{f.surface.order[neighbour]} * 3 + axis] -
                        f.xyz[size_t{f.surface.order[r]} * 3 + axis];
    }
    for (uint32_t k = 0; k < planes; ++k) values(i, k) = f.value(k, neighbour) - f.value(k, r);
    const double sure =
        static_cast<double>(row.precision[static_cast<size_t>(i)]) * (i < row.ring ? 0.25 : 0.625);
    a(i, i) = sure;
    b(i) = sure * static_cast<double>(row.prior[static_cast<size_t>(i)]);
    a(i, n) = a(n, i) = 1;
  }
  const double noise = 0.25 + points.squaredNorm() / static_cast<double>(n) / 2048;
  a.topLeftCorner(n, n) +=
      points * points.transpose() / noise + share * values * values.transpose();
  b(n) = 1;
  return a.fullPivLu().solve(b).head(n);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Weights of all rows, sixteen at a time, the last ones more than once.
std::vector<float> run_kernel(const LaneWeightKernels& kernels, const Fixture& f) {
  std::vector<float> out(size_t{f.rows()} * kMaxNeighbours);
  for (uint32_t first = 0; first < f.rows(); first += kWeightRows) {
    uint32_t rows[kWeightRows];
    float* to[kWeightRows];
    for (uint32_t l = 0; l < kWeightRows; ++l) {
      rows[l] = std::min(first + l, f.rows() - 1);
      to[l] = &out[size_t{rows[l]} * kMaxNeighbours];
    }
    kernels.learn(f.task(2), rows, to);
  }
  return out;
}

/// Bits of the components from 8 on, where every row's values are one combination of its
/// neighbours', far from what the reference tells.
double later_bits(const Fixture& f, LaneField field) {
  LaneField::Planes targets(40);
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (auto& plane : targets) {
    for (const PredictionGraph::Row& row : f.surface.graph.rows) {
      const bool led = row.ring > 2;
      plane.push_back(led ? plane[row.neighbour[1]] : 200 * normal(random));
    }
  }
  const SymbolCosts costs = expected_costs();
  LaneFieldEncoder encoder(field, f.surface.graph, 0.1, 0, costs);
  double bits = 0;
  for (uint32_t k = 0, lanes = 0; k < 40; k += lanes) {
    lanes = lanes_of_block(k, 40);
    for (const CodedComponent& c :
         encoder.code_block({targets.begin() + k, targets.begin() + k + lanes}))
      bits += k > 0 ? c.bits : 0;
  }
  return bits;
}

}  // namespace

TEST_CASE("weights of lanes are the minimum of the documented objective", "[lane_weights]") {
  for (const Shape& shape : {torus(16, 11), with_isolated(grid(9, 8), 5), tetrahedron()}) {
    const Fixture f(shape);
    for (const uint32_t blocks : {0u, 1u, 2u}) {
      const std::vector<float> found = learn_all(f.task(blocks), f.rows());
      for (uint32_t r = 0; r < f.rows(); ++r) {
        const uint32_t count = f.surface.graph.rows[r].count;
        const Eigen::VectorXd best = best_weights(f, r, blocks == 0 ? 0 : 16 * blocks - 8);
        for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
          const double expected = i < count ? best[i] : 0.0;
          REQUIRE(static_cast<double>(found[r * kMaxNeighbours + i]) ==
                  Approx(expected).margin(4e-3));
        }
      }
    }
  }
}

TEST_CASE("wary rows trust values the less, the worse they were predicted", "[lane_weights]") {
  const Fixture f(torus(16, 11));
  std::vector<uint32_t> history;
  for (uint32_t r = 0; r < f.rows(); ++r) history.push_back(16 * (r % 5));
  LaneWeightTask task = f.task(2);
  task.history = history.data();
  const std::vector<float> found = learn_all(task, f.rows());
  for (uint32_t r = 0; r < f.rows(); ++r) {
    const double share = 1.0 / (8 + 2 * (r % 5) * (r % 5));
    const Eigen::VectorXd best = best_weights(f, r, 24, share);
    for (Eigen::Index i = 0; i < best.size(); ++i) {
      REQUIRE(static_cast<double>(found[r * kMaxNeighbours + static_cast<size_t>(i)]) ==
              Approx(best[i]).margin(4e-3));
    }
  }
}

TEST_CASE("a surface's start is what its reference tells", "[lane_weights]") {
  const Fixture f(torus(16, 11));
  CHECK(same_bits(f.start.weights, learn_all(f.task(0), f.rows())));
  for (uint32_t r = 0; r < f.rows(); ++r) {
    for (uint32_t a = 0; a < 3; ++a) {
      REQUIRE(f.start.points[r * kPointStride + a] ==
              static_cast<float>(f.xyz[size_t{f.surface.order[r]} * 3 + a]));
    }
  }
}

TEST_CASE("only the rows that are asked for get new weights", "[lane_weights]") {
  const Fixture f(torus(16, 11));
  const std::vector<float> all = learn_all(f.task(1), f.rows());
  std::vector<float> some = f.start.weights;
  learn_weights(f.task(1), std::vector<uint32_t>{20, 90}, some);
  for (uint32_t r = 0; r < f.rows(); ++r) {
    const std::vector<float>& expected = r == 20 || r == 90 ? all : f.start.weights;
    for (uint32_t i = r * kMaxNeighbours; i < (r + 1) * kMaxNeighbours; ++i)
      REQUIRE(some[i] == expected[i]);
  }
}

TEST_CASE("every instruction set finds the same weights of lanes", "[lane_weights]") {
  for (const float size : {9.0f, 1e8f, 1e25f}) {  // the last one is beyond what binary32 can square
    const Fixture f(torus(16, 11), size);
    const std::vector<float> base =
        run_kernel(kernels_for<LaneWeightKernels>(InstructionSet::kBase), f);
    const auto same = [&](const std::vector<float>& other) {
      for (size_t i = 0; i < base.size(); ++i) {
        const bool both_none = std::isnan(base[i]) && std::isnan(other[i]);
        if (!both_none && base[i] != other[i]) return false;
      }
      return true;
    };
    for (const InstructionSet set : instruction_sets())
      CHECK(same(run_kernel(kernels_for<LaneWeightKernels>(set), f)));
  }
}

TEST_CASE("a field learns from its first blocks", "[lane_weights]") {
  const Fixture f(torus(30, 20));
  const double kept = later_bits(f, LaneField(f.surface.graph, f.start.weights));
  CHECK(later_bits(f, LaneField(f.surface.graph, f.start, false)) < 0.7 * kept);
}
