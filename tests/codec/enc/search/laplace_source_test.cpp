#include "codec/enc/search/laplace_source.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace reeb {
namespace {

/// The same figures by summing small slices of the density.
RatePoint by_slices(double scale, double step, double threshold = 0.5) {
  constexpr int kSlices = 2000;
  RatePoint out;
  for (int n = -200; n <= 200; ++n) {
    double probability = 0;
    const double half = n == 0 ? threshold : 0.5;
    const double begin = n == 1 ? threshold : n - half;
    const double end = n == -1 ? -threshold : n + half;
    for (int i = 0; i < kSlices; ++i) {
      const double x = (begin + (end - begin) * (i + 0.5) / kSlices) * step;
      const double mass =
          std::exp(-std::abs(x) / scale) / (2 * scale) * (end - begin) * step / kSlices;
      probability += mass;
      out.distortion += mass * (x - n * step) * (x - n * step);
    }
    if (probability > 0) out.bits -= probability * std::log2(probability);
  }
  return out;
}

}  // namespace

TEST_CASE("rate and distortion of a quantized Laplace source are those of its density") {
  for (const double step : {0.2, 1.0, 3.0, 8.0}) {
    const RatePoint expected = by_slices(1.5, step);
    const RatePoint point = quantized_laplace_source(1.5, step);
    CHECK(point.bits == Approx(expected.bits).epsilon(1e-3));
    CHECK(point.distortion == Approx(expected.distortion).epsilon(1e-3));
  }
}

TEST_CASE("a dead zone is that of the density") {
  for (const double threshold : {0.6, 0.85, 1.2}) {
    for (const double step : {0.3, 2.0, 6.0}) {
      const RatePoint expected = by_slices(1.5, step, threshold);
      const RatePoint point = quantized_laplace_source(1.5, step, threshold);
      CHECK(point.bits == Approx(expected.bits).epsilon(1e-3));
      CHECK(point.distortion == Approx(expected.distortion).epsilon(1e-3));
    }
  }
}

TEST_CASE("the chosen step is the high-rate one for a wide source and larger for a narrow one") {
  const double slope = std::log(2.0) / 6;  // of a step of 1 at high rate
  CHECK(laplace_source_step(100, slope) == Approx(1).epsilon(0.05));
  const double narrow = laplace_source_step(0.2, slope);
  const RatePoint chosen = quantized_laplace_source(0.2, narrow);
  const RatePoint plain = quantized_laplace_source(0.2, 1);
  CHECK(chosen.distortion + slope * chosen.bits < plain.distortion + slope * plain.bits);
}

TEST_CASE("a source without energy costs nothing") {
  const RatePoint point = quantized_laplace_source(0, 1);
  CHECK(point.bits == Approx(0).margin(1e-9));
  CHECK(point.distortion == Approx(0).margin(1e-9));
}

}  // namespace reeb
