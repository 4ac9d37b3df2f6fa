#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "retrieval/assignment.h"
#include "retrieval/shape_distance.h"

using namespace reeb::retrieval;

namespace {

ChartSignature chart(float share, float area, bool annulus = false) {
  ChartSignature c;
  c.annulus = annulus;
  c.share = share;
  c.area = area;
  for (auto* profile : {&c.area_stretch, &c.angle_stretch, &c.thickness})
    profile->assign(kProfileLength, 0.0f);
  return c;
}

double best_by_trying(const Eigen::MatrixXd& cost) {
  std::vector<Eigen::Index> columns(cost.cols());
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  double best = 1e9;
  do {
    double sum = 0;
    for (Eigen::Index i = 0; i < cost.rows(); ++i) sum += cost(i, columns[i]);
    best = std::min(best, sum);
  } while (std::next_permutation(columns.begin(), columns.end()));
  return best;
}

double sum_of(const Eigen::MatrixXd& cost, const std::vector<uint32_t>& match) {
  double sum = 0;
  for (size_t i = 0; i < match.size(); ++i) {
    if (match[i] != kUnmatched) sum += cost(i, match[i]);
  }
  return sum;
}

}  // namespace

TEST_CASE("The best assignment is that of all permutations", "[assignment]") {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const int rows = 1 + trial % 5, columns = rows + trial % 3;
    Eigen::MatrixXd cost(rows, columns);
    for (double& c : cost.reshaped()) c = static_cast<double>(random() % 100) - 50;
    const double best = best_by_trying(cost);
    CHECK(sum_of(cost, best_assignment(cost)) == Approx(best));
    const Eigen::MatrixXd turned = cost.transpose();
    CHECK(sum_of(turned, best_assignment(turned)) == Approx(best));
  }
}

TEST_CASE("Charts differ by what is different", "[distance]") {
  const ChartSignature a = chart(0.5f, 1);
  CHECK(chart_distance(a, a) == 0);
  ChartSignature b = a;
  b.area += 2;  // half of it counts: 1 / (1 + 1)
  CHECK(chart_distance(a, b) == Approx(0.5));
  CHECK(chart_distance(b, a) == Approx(0.5));
  b = chart(0.5f, 1, true);
  CHECK(chart_distance(a, b) == Approx(0.5 / 1.5));
  // A tube seen from its other end is the same tube.
  ChartSignature c = b;
  b.thickness.front() = 4;
  c.thickness.back() = 4;
  CHECK(chart_distance(b, c) == 0);
}

TEST_CASE("Charts without a match count by their size", "[distance]") {
  Signature a, b;
  a.charts = {chart(0.64f, 1), chart(0.36f, 3)};
  b.charts = {chart(0.64f, 1)};
  // Sizes are roots of shares: 0.8 of a mean of 1.1 is alike.
  const ChartMatch match = match_charts(a, b);
  CHECK(match.match == std::vector<uint32_t>{0, kUnmatched});
  CHECK(match.distance == Approx(1 - 0.8 / 1.1));
  CHECK(match_charts(b, a).distance == Approx(match.distance));
  CHECK(match_charts(a, a).distance == Approx(0).margin(1e-6));
  CHECK(match_charts(a, {}).distance == 1);
}

TEST_CASE("What one part tells for sure counts more than the doubts of the others", "[distance]") {
  Signature a;
  a.heat.assign(kSpectralValues, 1);
  a.wave.assign(kSpectralValues, 1);
  a.thickness.assign(kBodyValues, 1);
  a.straightness.assign(kBodyValues, 0.5f);
  a.curvature.assign(kBodyValues, 2);
  a.reach.assign(kBodyValues, -1);
  CHECK(shape_distance(a, a).total == Approx(0).margin(1e-12));
  // Twice what is typical in three parts; a thickness that is another everywhere is another size.
  Signature b = a;
  for (float& v : b.heat) v += 0.34f;
  for (float& v : b.wave) v -= 0.44f;
  for (float& v : b.thickness) v += 3;
  for (float& v : b.straightness) v += 0.132f;
  const ShapeDistance d = shape_distance(a, b);
  CHECK(d.spectrum == Approx(2));
  CHECK(d.body == Approx(0.5));
  CHECK(d.charts == 0);
  CHECK(d.total == Approx(std::pow(std::pow(0.01, 4) * std::pow(2.01, 3), 1.0 / 7) - 0.01));
  CHECK(shape_distance(b, a).total == Approx(d.total));
  for (float& v : b.curvature) v -= 1.66f;
  for (float& v : b.reach) v += 0.36f;
  CHECK(shape_distance(a, b).body == Approx(0.25 * (0 + 2 + 2 + 2)));
}

TEST_CASE("Of charts alike the one beside the matched neighbour is taken", "[distance]") {
  // Two pairs of neighbours whose first charts are alike in all but their neighbours.
  Signature a, b;
  a.charts = {chart(0.4f, 5), chart(0.3f, 2), chart(0.2f, 2), chart(0.1f, 0)};
  a.charts[0].neighbours = {1};
  a.charts[1].neighbours = {0};
  a.charts[2].neighbours = {3};
  a.charts[3].neighbours = {2};
  for (ChartSignature& c : a.charts) c.share = 0.25f;
  b = a;
  b.charts[0].neighbours = {2};
  b.charts[2].neighbours = {0};
  b.charts[1].neighbours = {3};
  b.charts[3].neighbours = {1};
  const ChartMatch match = match_charts(a, b);
  CHECK(match.match == std::vector<uint32_t>{0, 2, 1, 3});
}
