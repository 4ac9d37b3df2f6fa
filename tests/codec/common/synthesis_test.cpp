#include "codec/common/synthesis.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace reeb;

namespace {

std::vector<float> random_values(size_t count, std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0, size);
  std::vector<float> out(count);
  for (float& x : out) x = static_cast<float>(normal(random));
  return out;
}

}  // namespace

TEST_CASE("a frame is the mean plus the sum of basis times planes", "[synthesis]") {
  std::mt19937 random(1);
  constexpr uint32_t kRows = 1100, kFrames = 4, kComponents = 5;  // more than two blocks of rows
  std::vector<std::vector<float>> planes, basis;
  for (uint32_t k = 0; k < kComponents; ++k) {
    planes.push_back(random_values(kRows, random, 10));
    basis.push_back(random_values(3 * kFrames, random, 0.3));
  }
  std::vector<double> mean(3 * kFrames);
  for (double& m : mean) m = 100 + static_cast<double>(random() % 1000);
  const GroupSynthesis synthesis(planes, basis, mean);
  REQUIRE(synthesis.frame_count() == kFrames);
  std::vector<uint32_t> output(kRows);
  std::iota(output.begin(), output.end(), 0u);
  std::shuffle(output.begin(), output.end(), random);

  for (const size_t stride : {size_t{3}, size_t{5}}) {
    for (uint32_t t = 0; t < kFrames; ++t) {
      std::vector<float> xyz(kRows * stride, -77.0f);
      synthesis.frame(t, output, xyz.data(), stride);
      for (uint32_t r = 0; r < kRows; ++r) {
        for (uint32_t a = 0; a < 3; ++a) {
          double expected = mean[t * 3 + a];
          for (uint32_t k = 0; k < kComponents; ++k)
            expected +=
                static_cast<double>(basis[k][t * 3 + a]) * static_cast<double>(planes[k][r]);
          const double found = static_cast<double>(xyz[output[r] * stride + a]);
          REQUIRE(found == Approx(expected).epsilon(0).margin(1e-4));
        }
        for (size_t a = 3; a < stride; ++a) REQUIRE(xyz[output[r] * stride + a] == -77.0f);
      }
    }
  }
}

TEST_CASE("the sum is in binary32 and the mean is added in binary64", "[synthesis]") {
  // 1 + 2^-25 is 1 in binary32; the mean 2^-26 then lifts the exact sum not above a tie.
  const std::vector<std::vector<float>> planes = {{1.0f}, {0x1p-25f}};
  const std::vector<std::vector<float>> basis = {{1.0f, 1.0f, 1.0f}, {1.0f, 1.0f, 1.0f}};
  const GroupSynthesis synthesis(planes, basis, {0x1p-26, 0x1.8p-24, 1e6 + 0x1p-20});
  float xyz[3];
  synthesis.frame(0, std::vector<uint32_t>{0}, xyz, 3);
  CHECK(xyz[0] == 1.0f);
  CHECK(xyz[1] == 1.0f + 0x1p-23f);
  CHECK(xyz[2] == 1000001.0f);
}

TEST_CASE("no components leave the mean", "[synthesis]") {
  const GroupSynthesis synthesis({}, {}, {1, 2, 3, 4, 5, 6});
  float xyz[6];
  synthesis.frame(1, std::vector<uint32_t>{1, 0}, xyz, 3);
  for (int i = 0; i < 6; ++i) CHECK(xyz[i] == static_cast<float>(4 + i % 3));
}

TEST_CASE("the norm of a plane is Euclidean", "[synthesis]") {
  CHECK(plane_norm({}) == 0);
  CHECK(plane_norm({3, 0, -4}) == 5);
  CHECK(std::isfinite(plane_norm({1e38f, 1e38f})));
}

TEST_CASE("decoded fields are scaled by the step and the norms of the planes", "[synthesis]") {
  // Nine vertices, so that the mean trajectory counts a third of its coded value.
  const TemporalGraph temporal = build_temporal_graph(2);
  std::vector<std::vector<float>> planes = {{3, 0, 4, 0, 0, 0, 0, 0, 0},
                                            std::vector<float>(9, 0.0f)};
  std::vector<std::vector<float>> basis(3);
  for (int k = 0; k < 3; ++k) {
    for (int row = 0; row < 6; ++row) basis[k].push_back(static_cast<float>(7 * k + 2 * row - 5));
  }
  const float origin[3] = {10, 20, 30};
  constexpr double kQ = 0.5;
  const GroupSynthesis s = synthesize(9, planes, basis, temporal.order, kQ, origin);
  for (size_t r = 0; r < 6; ++r) {
    const uint32_t at = temporal.order[r];
    const double coded_mean = static_cast<double>(basis[0][r]);
    CHECK(s.mean(at) == Approx(static_cast<double>(origin[at % 3]) + coded_mean * kQ / 3));
    const double coded = static_cast<double>(basis[1][r]);
    CHECK(static_cast<double>(s.basis(at)[0]) == Approx(coded * kQ / 5));
    CHECK(s.basis(at)[1] == 0.0f);  // of a plane of zeros
  }
}
