#include "codec/common/synthesis/synthesis.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "codec/common/prediction/prediction_graph.h"

using namespace reeb;

namespace {

template <class T>
std::vector<T> random_values(size_t count, std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0, size);
  std::vector<T> out(count);
  for (T& x : out) x = static_cast<T>(normal(random));
  return out;
}

constexpr double kQ = 0.25;

GroupSynthesis make(std::vector<std::vector<float>> planes,
                    const std::vector<std::vector<double>>& basis, std::vector<double> mean,
                    const std::vector<uint32_t>& output, double q = kQ) {
  return {ComponentSum(std::move(planes), basis, q, output), std::move(mean)};
}

}  // namespace

TEST_CASE("a frame is the mean plus the sum of basis times planes", "[synthesis]") {
  std::mt19937 random(1);
  const uint32_t components = GENERATE(1u, 5u, 20u);
  constexpr uint32_t kRows = 1100, kFrames = 20;  // several tiles, the last one not full
  std::vector<std::vector<float>> planes;
  std::vector<std::vector<double>> basis;
  for (uint32_t k = 0; k < components; ++k) {
    planes.push_back(random_values<float>(kRows, random, 1000.0 / (1 + k * k)));
    basis.push_back(random_values<double>(3 * kFrames, random, 0.1));
  }
  std::vector<double> mean(3 * kFrames);
  for (double& m : mean) m = 100 + static_cast<double>(random() % 1000);
  std::vector<uint32_t> output(kRows);
  std::iota(output.begin(), output.end(), 0u);
  std::shuffle(output.begin(), output.end(), random);
  const GroupSynthesis synthesis = make(planes, basis, mean, output);
  REQUIRE(synthesis.frame_count() == kFrames);
  REQUIRE(synthesis.components().wide_count() >= 1);
  if (components > 10) REQUIRE(synthesis.components().wide_count() < 5);

  for (const size_t stride : {size_t{3}, size_t{5}}) {
    const size_t frame_stride = kRows * stride + 7;
    std::vector<float> all(kFrames * frame_stride, -77.0f);
    synthesis.frames(1, kFrames - 1, all.data(), frame_stride, stride);
    for (uint32_t t = 1; t < kFrames; ++t) {
      const float* xyz = &all[(t - 1) * frame_stride];
      std::vector<float> alone(kRows * stride, -77.0f);
      synthesis.frame(t, alone.data(), stride);
      REQUIRE(std::equal(alone.begin(), alone.end(), xyz));
      for (uint32_t r = 0; r < kRows; ++r) {
        for (uint32_t a = 0; a < 3; ++a) {
          double expected = mean[t * 3 + a];
          for (uint32_t k = 0; k < components; ++k)
            expected += kQ * basis[k][t * 3 + a] * static_cast<double>(planes[k][r]);
          const double found = static_cast<double>(xyz[output[r] * stride + a]);
          REQUIRE(found == Approx(expected).epsilon(0).margin(0.03 * kQ));
        }
        for (size_t a = 3; a < stride; ++a) REQUIRE(xyz[output[r] * stride + a] == -77.0f);
      }
    }
  }
}

TEST_CASE("wide components are summed in binary32, the mean is added in binary64", "[synthesis]") {
  // 1 + 2^-25 is 1 in binary32; the mean 2^-26 then lifts the exact sum not above a tie.
  const std::vector<std::vector<float>> planes = {{1.0f}, {1024.0f}};
  const std::vector<std::vector<double>> basis = {{1, 1, 1}, {0x1p-35, 0x1p-35, 0x1p-35}};
  const GroupSynthesis synthesis = make(planes, basis, {0x1p-26, 0x1.8p-24, 1e6 + 0x1p-20}, {0}, 1);
  CHECK(synthesis.components().wide_count() == 2);
  float xyz[3];
  synthesis.frame(0, xyz, 3);
  CHECK(xyz[0] == 1.0f);
  CHECK(xyz[1] == 1.0f + 0x1p-23f);
  CHECK(xyz[2] == 1000001.0f);
}

TEST_CASE("narrow components are rounded, and their sum is exact", "[synthesis]") {
  // Planes count in 1/64, ties to even; basis vectors in 1/32768.
  const std::vector<std::vector<float>> planes = {{3.3f, -511.9f}, {0.5f / 64, 1.5f / 64}};
  const std::vector<std::vector<double>> basis = {{0.25, -0.99998, 1e-6}, {0.5, 0.5, 2.5 / 32768}};
  const GroupSynthesis synthesis = make(planes, basis, {0, 1, 2}, {1, 0}, 64 * 32768.0);
  CHECK(synthesis.components().wide_count() == 0);
  CHECK(synthesis.components().basis(1, 0) == 64 * -32767.0);
  CHECK(synthesis.components().basis(2, 1) == 64 * 2.0);
  float xyz[6];
  synthesis.frame(0, xyz, 3);
  const std::vector<float> expected = {
      -32762.0f * 8192 + 2 * 16384,  // the second vertex: -511.9 * 64 = -32761.6, and 2
      1.0f + 32762.0f * 32767 + 2 * 16384,
      2.0f + 2 * 2,
      211.0f * 8192,  // the first one: 3.3 * 64 = 211.2, and 0
      1.0f - 211.0f * 32767,
      2.0f};
  CHECK(std::vector<float>(xyz, xyz + 6) == expected);
}

TEST_CASE("as many components are narrow as a sum of 32 bits holds", "[synthesis]") {
  const auto wide = [](std::vector<float> sizes, double share) {
    std::vector<std::vector<float>> planes;
    for (const float size : sizes) planes.push_back({size});
    const std::vector<std::vector<double>> basis(sizes.size(), {0, share, 0});
    return make(planes, basis, {0, 0, 0}, {0}).components().wide_count();
  };
  CHECK(wide({511, 511, 511}, 0.999) == 1);  // 511 * 64 * 32735 = 1070564440, a little below 2^30
  CHECK(wide({511, 511, 511}, 0.6) == 0);
  CHECK(wide({1, 511.999f, 1}, 0.1) == 2);  // 32768 is too large
  CHECK(wide({1, 1, 1}, 1) == 3);           // so is a basis vector of 32768
  CHECK(wide({0, 0}, 0) == 0);
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK(wide({infinity, 1}, 0.1) == 1);
  CHECK(wide({std::nanf(""), 1}, 0.1) == 1);
  CHECK(wide({1, 1}, std::nan("")) == 2);
}

TEST_CASE("no components leave the mean", "[synthesis]") {
  const GroupSynthesis synthesis = make({}, {}, {1, 2, 3, 4, 5, 6}, {1, 0});
  float xyz[6];
  synthesis.frame(1, xyz, 3);
  for (int i = 0; i < 6; ++i) CHECK(xyz[i] == static_cast<float>(4 + i % 3));
}

TEST_CASE("the norm of a plane is Euclidean", "[synthesis]") {
  CHECK(plane_norms({}).empty());
  CHECK(plane_norms({{}}) == std::vector<double>{0});
  CHECK(plane_norms({{3, 0, -4}, {0, 0, 0}}) == std::vector<double>{5, 0});
  CHECK(std::isfinite(plane_norms({{1e38f, 1e38f}})[0]));
  std::vector<std::vector<float>> many;  // more than are summed at once
  for (int k = 0; k < 11; ++k) many.push_back({static_cast<float>(k), 0});
  for (int k = 0; k < 11; ++k) CHECK(plane_norms(many)[k] == k);
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
  std::vector<uint32_t> output(9);
  std::iota(output.begin(), output.end(), 0u);
  const GroupSynthesis s = synthesize(planes, basis, temporal.order, kQ, origin, output);
  for (size_t r = 0; r < 6; ++r) {
    const uint32_t at = temporal.order[r];
    const double coded_mean = static_cast<double>(basis[0][r]);
    CHECK(s.mean(at) == Approx(static_cast<double>(origin[at % 3]) + coded_mean * kQ / 3));
    const double coded = static_cast<double>(basis[1][r]);
    CHECK(s.components().basis(at, 0) == Approx(coded * kQ / 5).margin(kQ / 65536));
    CHECK(s.components().basis(at, 1) == 0);  // of a plane of zeros
  }
}
