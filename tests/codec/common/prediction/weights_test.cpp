#include "codec/common/prediction/weights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

struct Fixture {
  std::vector<int32_t> xyz;
  SurfaceGraph surface;
  std::vector<std::vector<float>> planes;
  std::vector<double> noise;

  /// Smooth planes with noise: neighbours agree, more or less.
  explicit Fixture(const Shape& shape, uint32_t plane_count = 6)
      : xyz(on_grid(shape, 12)),
        surface(build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity))) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (uint32_t k = 0; k < plane_count; ++k) {
      std::vector<float>& plane = planes.emplace_back();
      for (const uint32_t v : surface.order) {
        const float* p = &shape.positions[size_t{v} * 3];
        const double x = static_cast<double>(p[0]), y = static_cast<double>(p[1]);
        plane.push_back(
            static_cast<float>(9 * std::sin(x + k) * std::cos(0.7 * y) + normal(random)));
      }
      noise.push_back(0.05 + 0.3 * k);
    }
  }
};

/// Minimum of the objective in weights.h, by one dense system with a multiplier for the sum.
Eigen::VectorXd best_weights(const Fixture& f, uint32_t r, const WeightOptions& options) {
  const PredictionGraph::Row& row = f.surface.graph.rows[r];
  const Eigen::Index n = row.count;
  if (n == 0) return {};
  const Eigen::Index size = n + (options.sum_to_one ? 1 : 0);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (size_t o = 0; o < f.planes.size(); ++o) {
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) y[i] = f.planes[o][row.neighbour[i]];
    a.topLeftCorner(n, n) += y * y.transpose() / f.noise[o];
    b.head(n) += y * static_cast<double>(f.planes[o][r]) / f.noise[o];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double deviation = i < row.ring ? options.ring_deviation : options.extra_deviation;
    const double precision = static_cast<double>(row.precision[i]) / (deviation * deviation);
    a(i, i) += precision;
    b[i] += static_cast<double>(row.prior[i]) * precision;
  }
  if (options.sum_to_one) {
    a.row(n).head(n).setOnes();
    a.col(n).head(n).setOnes();
    b[n] = 1;
  }
  return a.fullPivLu().solve(b).head(n);
}

/// An estimator and what it has been shown.
struct Learner {
  WeightEstimator estimator;
  WeightEstimator::Planes planes;

  Learner(const Fixture& f, const WeightOptions& options = {}, unsigned threads = 1)
      : estimator(f.surface.graph, options, threads) {}

  /// `misses(r)` tells whether row r does.
  template <class Misses>
  void observe(const std::vector<float>& plane, double noise, Misses misses) {
    estimator.begin_component(planes);
    planes.push_back(plane);
    for (uint32_t r = 0; r < plane.size(); ++r) {
      if (misses(r)) estimator.miss(r);
    }
    estimator.finish_component(noise);
  }
  void solve(uint32_t misses = 1) { estimator.solve(misses, planes); }
};

bool all_rows(uint32_t) { return true; }

std::vector<float> estimate(const Fixture& f, const WeightOptions& options, unsigned threads,
                            bool reference = false) {
  Learner learner(f, options, threads);
  if (reference) learner.estimator.observe_reference(GridPoints(f.xyz), f.surface.order);
  for (size_t o = 0; o < f.planes.size(); ++o) {
    learner.observe(f.planes[o], f.noise[o], all_rows);
    if (o % 2 == 1) learner.solve();  // observations add up over several solves
  }
  learner.solve();
  const float* first = learner.estimator.weights(0);
  return {first, first + size_t{f.surface.graph.size()} * kMaxNeighbours};
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// All weights after each component; every third row misses it.
std::vector<std::vector<float>> follow(Learner learner, const Fixture& f) {
  std::vector<std::vector<float>> out;
  const float* first = learner.estimator.weights(0);
  const auto note = [&] {
    out.emplace_back(first, first + size_t{f.surface.graph.size()} * kMaxNeighbours);
  };
  note();
  for (uint32_t o = 0; o < f.planes.size(); ++o) {
    learner.observe(f.planes[o], f.noise[o], [o](uint32_t r) { return (r + o) % 3 == 0; });
    learner.solve();
    note();
  }
  return out;
}

/// Eight rows at work, from row 40 of the fixture on.
std::vector<float> run_kernels(const WeightKernels& kernels, const Fixture& f, bool sum_to_one) {
  const auto observations = static_cast<uint32_t>(f.planes.size());
  std::vector<const float*> planes;
  std::vector<double> scale;
  for (uint32_t o = 0; o < observations; ++o) {
    planes.push_back(f.planes[o].data());
    scale.push_back(1 / std::sqrt(f.noise[o]));
  }
  std::vector<float> out(kRowsAtOnce * kMaxNeighbours, 1.0f);
  std::vector<RowEquations> equations(f.surface.graph.size());
  std::vector<RowTarget> targets(f.surface.graph.size());
  uint32_t rows[kRowsAtOnce];
  float* to[kRowsAtOnce];
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    const uint32_t r = rows[l] = 40 + l * 3;
    const PredictionGraph::Row& row = f.surface.graph.rows[r];
    kernels.fold(
        equations[r], sum_to_one ? nullptr : targets[r].data(),
        {planes.data(), scale.data(), row.neighbour.data(), row.count, r, 1, observations});
    to[l] = &out[l * kMaxNeighbours];
  }
  kernels.solve({f.surface.graph.rows.data(), equations.data(),
                 sum_to_one ? nullptr : targets.data(), 0.7, 1.3},
                rows, to);
  return out;
}

}  // namespace

TEST_CASE("weights are the minimum of the documented objective", "[weights]") {
  for (const Shape& shape : {torus(16, 11), with_isolated(grid(9, 8), 5), tetrahedron()}) {
    const Fixture f(shape);
    for (const bool sum_to_one : {false, true}) {
      const WeightOptions options{
          .ring_deviation = 0.9, .extra_deviation = 0.4, .sum_to_one = sum_to_one};
      const std::vector<float> found = estimate(f, options, 1);
      for (uint32_t r = 0; r < f.surface.graph.size(); ++r) {
        const uint32_t count = f.surface.graph.rows[r].count;
        const Eigen::VectorXd expected = best_weights(f, r, options);
        INFO(shape.name << " row " << r);
        for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
          const double w = static_cast<double>(found[r * kMaxNeighbours + i]);
          REQUIRE(w == Approx(i < count ? expected[i] : 0.0).margin(2e-6));
        }
      }
    }
  }
}

TEST_CASE("without observations the weights are the prior", "[weights]") {
  const Fixture f(torus(16, 11), 0);
  const std::vector<float> found = estimate(f, {}, 1);
  for (uint32_t r = 0; r < f.surface.graph.size(); ++r) {
    for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
      const auto prior = static_cast<double>(f.surface.graph.rows[r].prior[i]);
      // The sum is brought to one, from which the priors' rounding is some 1/65536 away.
      REQUIRE(static_cast<double>(found[r * kMaxNeighbours + i]) == Approx(prior).margin(3e-4));
    }
  }
}

TEST_CASE("weights from the reference reproduce it better than the prior", "[weights]") {
  const Fixture f(torus(30, 20), 0);
  const GridPoints points(f.xyz);
  const std::vector<float> found = estimate(f, {}, 1, true);
  double learned = 0, prior = 0;
  for (uint32_t r = 0; r < f.surface.graph.size(); ++r) {
    const PredictionGraph::Row& row = f.surface.graph.rows[r];
    if (row.count < 8) continue;
    for (int a = 0; a < 3; ++a) {
      const double exact = points[f.surface.order[r]][a];
      double by_learned = 0, by_prior = 0, sum = 0;
      for (uint32_t i = 0; i < row.count; ++i) {
        const double x = points[f.surface.order[row.neighbour[i]]][a];
        by_learned += static_cast<double>(found[r * kMaxNeighbours + i]) * x;
        by_prior += static_cast<double>(row.prior[i]) * x;
        sum += static_cast<double>(found[r * kMaxNeighbours + i]);
      }
      REQUIRE(sum == Approx(1).margin(1e-5));
      learned += std::pow(by_learned - exact, 2);
      prior += std::pow(by_prior - exact, 2);
    }
  }
  CHECK(learned < 0.1 * prior);
}

TEST_CASE("weights do not depend on the number of threads", "[weights]") {
  const Fixture f(torus(31, 17));
  for (const bool sum_to_one : {false, true}) {
    const WeightOptions options{.sum_to_one = sum_to_one};
    const std::vector<float> one = estimate(f, options, 1, true);
    CHECK(same_bits(one, estimate(f, options, 3, true)));
    CHECK(same_bits(one, estimate(f, options, 64, true)));
  }
}

TEST_CASE("every instruction set gives the same bits", "[weights]") {
  const Fixture f(torus(16, 11));
  for (const bool sum_to_one : {false, true}) {
    const std::vector<float> base =
        run_kernels(kernels_for<WeightKernels>(InstructionSet::kBase), f, sum_to_one);
    for (const InstructionSet set : instruction_sets())
      CHECK(same_bits(base, run_kernels(kernels_for<WeightKernels>(set), f, sum_to_one)));
  }
}

TEST_CASE("values of any size leave finite weights", "[weights]") {
  Fixture f(torus(8, 6), 4);
  for (std::vector<float>& plane : f.planes) {
    for (float& x : plane) x *= 1e12f;
  }
  for (const bool sum_to_one : {false, true}) {
    for (const float w : estimate(f, {.sum_to_one = sum_to_one}, 1)) REQUIRE(std::isfinite(w));
  }
}

TEST_CASE("what rows predict without error they need not learn", "[weights]") {
  const Fixture f(torus(16, 11), 40);
  Learner lazy(f);
  Learner eager(f);
  std::mt19937 random(9);
  const uint32_t rows = f.surface.graph.size();
  for (size_t o = 0; o < f.planes.size(); ++o) {
    lazy.solve();
    eager.solve();
    std::vector<float> plane(rows);
    std::vector<bool> missed(rows);
    for (uint32_t r = 0; r < rows; ++r) {
      const PredictionGraph::Row& row = f.surface.graph.rows[r];
      for (uint32_t i = 0; i < row.count; ++i)
        plane[r] += lazy.estimator.weights(r)[i] * plane[row.neighbour[i]];
      missed[r] = r < 20 || random() % 8 == 0;
      if (missed[r]) plane[r] += std::round(f.planes[o][r]);
    }
    lazy.observe(plane, f.noise[o], [&](uint32_t r) { return missed[r]; });
    eager.observe(plane, f.noise[o], all_rows);
    if (o >= kObservations) continue;  // until then nothing is forgotten
    for (size_t i = 0; i < size_t{rows} * kMaxNeighbours; ++i)
      REQUIRE(lazy.estimator.weights(0)[i] == Approx(eager.estimator.weights(0)[i]).margin(1e-4));
  }
}

TEST_CASE("rows learn from the lists in which they missed", "[weights]") {
  Fixture f(torus(16, 11), 2 * kObservations);
  Learner learner(f);
  const auto misses = [](uint32_t r, size_t o) {  // even rows in the first list, all in the second
    return o == 3 ? r % 2 == 0 : o == kObservations + 5;
  };
  learner.solve();
  for (size_t o = 0; o < f.planes.size(); ++o)
    learner.observe(f.planes[o], f.noise[o], [&](uint32_t r) { return misses(r, o); });
  learner.solve();
  Fixture late = f;
  late.planes.erase(late.planes.begin(), late.planes.begin() + kObservations);
  late.noise.erase(late.noise.begin(), late.noise.begin() + kObservations);
  for (uint32_t r = 0; r < f.surface.graph.size(); ++r) {
    const Eigen::VectorXd expected = best_weights(r % 2 == 0 ? f : late, r, {});
    for (uint32_t i = 0; i < f.surface.graph.rows[r].count; ++i)
      REQUIRE(static_cast<double>(learner.estimator.weights(r)[i]) ==
              Approx(expected[i]).margin(2e-6));
  }
}

TEST_CASE("faded observations count less", "[weights]") {
  Fixture f(torus(16, 11));
  Learner faded(f);
  for (size_t o = 0; o < f.planes.size(); ++o) {
    faded.observe(f.planes[o], f.noise[o], all_rows);
    f.noise[o] *= 4;
  }
  faded.estimator.fade(0.25, faded.planes);
  faded.planes.clear();
  faded.solve();
  for (uint32_t r = 0; r < f.surface.graph.size(); ++r) {
    const Eigen::VectorXd expected = best_weights(f, r, {});
    for (uint32_t i = 0; i < f.surface.graph.rows[r].count; ++i)
      REQUIRE(static_cast<double>(faded.estimator.weights(r)[i]) ==
              Approx(expected[i]).margin(2e-6));
  }
}

TEST_CASE("rows are solved for when they have missed often enough", "[weights]") {
  const Fixture f(torus(16, 11), 6);
  Learner learner(f);
  const uint32_t rows = f.surface.graph.size();
  const auto observe_with_misses = [&](size_t o) {  // row r misses in the first r mod 4 components
    learner.observe(f.planes[o], f.noise[o], [o](uint32_t r) { return o < r % 4; });
  };
  learner.solve(200);  // rows never solved for are, whatever the number
  const float* const now = learner.estimator.weights(0);
  const std::vector<float> first(now, now + size_t{rows} * kMaxNeighbours);
  const auto count_changed = [&] {
    std::array<uint32_t, 4> changed{};
    for (uint32_t r = rows / 2; r < rows; ++r) {
      const float* w = learner.estimator.weights(r);
      changed[r % 4] += !std::equal(w, w + kMaxNeighbours, &first[size_t{r} * kMaxNeighbours]);
    }
    return changed;
  };
  for (size_t o = 0; o < 3; ++o) observe_with_misses(o);
  learner.solve(4);
  CHECK(count_changed() == std::array<uint32_t, 4>{});
  learner.solve(2);
  const uint32_t quarter = rows / 8;  // of the later half
  CHECK(count_changed() == std::array<uint32_t, 4>{0, 0, quarter, quarter});
  observe_with_misses(0);
  learner.solve(2);  // rows 1, 5, ... have two by now; the others had begun anew
  CHECK(count_changed() == std::array<uint32_t, 4>{0, quarter, quarter, quarter});
}

TEST_CASE("rows need more misses the more they know", "[weights]") {
  const std::vector<std::pair<uint32_t, uint32_t>> expected = {{0, 1},  {31, 1}, {32, 2},
                                                               {95, 2}, {96, 4}, {1u << 20, 4}};
  for (const auto& [k, misses] : expected) CHECK(misses_to_solve(k) == misses);
}

TEST_CASE("what is found again is what would have been kept", "[weights]") {
  const Fixture f(torus(20, 12));
  REQUIRE(f.planes.size() > 2);
  REQUIRE(f.planes.size() <= kObservations);
  const GridPoints points(f.xyz);
  Learner kept(f), borrowed(f);
  kept.estimator.observe_reference(points, f.surface.order);
  borrowed.estimator.borrow_reference(points, f.surface.order);
  const auto expected = follow(kept, f), found = follow(borrowed, f);
  for (size_t o = 0; o < expected.size(); ++o) {
    INFO("after " << o << " components");
    CHECK(same_bits(found[o], expected[o]));
  }
  CHECK_FALSE(same_bits(expected.front(), expected.back()));
}
