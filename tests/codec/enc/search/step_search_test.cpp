#include "codec/enc/search/step_search.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace reeb;

namespace {

/// ln(measured / wanted) for an error that grows as q^slope and is 1 at q = 1.
auto power_law(double slope, double wanted, int& calls) {
  return [=, &calls](double q) {
    ++calls;
    return std::log(std::pow(q, slope) / wanted);
  };
}

/// The search from q0 on.
StepTrial run(double q0, const StepSearchOptions& options,
              const std::function<double(double)>& measure) {
  return search_step({q0, measure(q0)}, options, measure);
}

}  // namespace

TEST_CASE("the search meets an error that grows with the step", "[step_search]") {
  for (const double slope : {0.4, 0.9, 1.0, 2.5}) {
    for (const double q0 : {1e-4, 0.5, 1.0, 300.0}) {
      int calls = 0;
      const StepTrial found = run(q0, {true, 0.008, 30}, power_law(slope, 0.37, calls));
      INFO("slope " << slope << " from " << q0);
      CHECK(found.excess <= 0);
      CHECK(found.excess >= -0.008);
      CHECK(found.q == Approx(std::pow(0.37, 1 / slope)).epsilon(0.03));
      CHECK(calls <= 31);
    }
  }
}

TEST_CASE("the search meets a size that falls with the step", "[step_search]") {
  for (const double slope : {-0.3, -0.7, -1.5}) {
    int calls = 0;
    const StepTrial found = run(7.0, {false, 0.008, 30}, power_law(slope, 2.0, calls));
    CHECK(found.excess <= 0);
    CHECK(found.excess >= -0.008);
  }
}

TEST_CASE("the search copes with a slope that changes", "[step_search]") {
  const auto measure = [](double q) { return std::log((q * q * q + 0.01 * q) / 0.002); };
  const StepTrial found = run(10.0, {true, 0.008, 30}, measure);
  CHECK(found.excess <= 0);
  CHECK(found.excess >= -0.008);
}

TEST_CASE("of steps that jump over the target the best below is given", "[step_search]") {
  // Measures -0.5 below q = 2 and +0.5 above.
  const auto measure = [](double q) { return q < 2 ? -0.5 : 0.5; };
  const StepTrial found = run(9.0, {true, 0.008, 40}, measure);
  CHECK(found.excess == -0.5);
  CHECK(found.q < 2);
}

TEST_CASE("a target out of reach gives the nearest miss and ends", "[step_search]") {
  int calls = 0;
  const auto measure = [&](double q) {
    ++calls;
    return 1 + std::log1p(q);  // never below 1
  };
  const StepTrial found = run(1.0, {true, 0.008, 12}, measure);
  CHECK(found.excess > 0);
  CHECK(found.excess < 1.1);
  CHECK(calls <= 13);
}

TEST_CASE("a target met by everything is met", "[step_search]") {
  int calls = 0;
  const auto measure = [&](double) {
    ++calls;
    return -1000.0;
  };
  CHECK(run(1.0, {true, 0.008, 12}, measure).excess == -1000.0);
  CHECK(calls <= 13);
}

TEST_CASE("the least cost is found from either side", "[step_search]") {
  for (const double q0 : {0.3, 1.0, 2.0, 3.2, 12.0}) {
    int calls = 0;
    const auto cost = [&](double q) {
      ++calls;
      return std::pow(std::log(q / 2.0), 2) + 5;
    };
    CHECK(search_least(q0, 1.35, 12, cost) == Approx(2.0).epsilon(0.06));
    CHECK(calls <= 13);
  }
}

TEST_CASE("the search for the least cost ends where there is none", "[step_search]") {
  int calls = 0;
  const auto falling = [&](double q) {
    ++calls;
    return -q;
  };
  CHECK(search_least(1.0, 1.5, 6, falling) == Approx(std::pow(1.5, 5)).epsilon(0.5));
  CHECK(calls <= 6);
  CHECK(search_least(1.0, 1.5, 6, [](double) { return 1.0; }) > 0);
}
