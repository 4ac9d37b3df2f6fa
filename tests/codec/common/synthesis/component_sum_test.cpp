#include "codec/common/synthesis/component_sum.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using namespace reeb;

namespace {

constexpr double kQ = 0.5;
constexpr uint32_t kFrames = 3;

std::vector<uint32_t> identity(uint32_t count) {
  std::vector<uint32_t> out(count);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

/// One component, the same everywhere.
ComponentSum constant(float value, double basis, uint32_t vertices = 5) {
  const std::vector<uint32_t> output = identity(vertices);
  return ComponentSum({std::vector<float>(vertices, value)},
                      {std::vector<double>(3 * kFrames, basis)}, kQ, output);
}

float first_coordinate(const ComponentSum& sum, double mean) {
  const std::vector<double> means(3 * kFrames, mean);
  std::vector<float> xyz(3 * 5);
  sum.frames(0, 1, means.data(), xyz.data(), 0, 3);
  return xyz[0];
}

}  // namespace

TEST_CASE("a component is narrow while its units fit 16 bits", "[component_sum]") {
  // Planes come in 1/64, 32767 of them at most; a half is rounded to even.
  CHECK(constant(32767 / 64.0f, 0.5).wide_count() == 0);
  CHECK(constant(32767.25f / 64.0f, 0.5).wide_count() == 0);
  CHECK(constant(32767.5f / 64.0f, 0.5).wide_count() == 1);
  CHECK(constant(-32768 / 64.0f, 0.5).wide_count() == 1);
  // Basis vectors in 1/32768, as many.
  CHECK(constant(1, 32767 / 32768.0).wide_count() == 0);
  CHECK(constant(1, 1.0).wide_count() == 1);
  CHECK(constant(1, std::numeric_limits<double>::quiet_NaN()).wide_count() == 1);
}

TEST_CASE("later components are narrow as long as their sum fits 31 bits", "[component_sum]") {
  // Each may add 32767 * 16384, of which 2^31 - 1 holds four but not five.
  const std::vector<uint32_t> output = identity(4);
  const std::vector<float> plane(4, 32767 / 64.0f);
  const std::vector<double> basis(3 * kFrames, 0.5);
  for (uint32_t count = 1; count < 8; ++count) {
    const ComponentSum sum(std::vector(count, plane), std::vector(count, basis), kQ, output);
    CHECK(sum.component_count() == count);
    CHECK(sum.wide_count() == (count > 4 ? count - 4 : 0));
  }
}

TEST_CASE("narrow values are rounded to their units and then summed exactly", "[component_sum]") {
  // 10.3 is 659.2 in 1/64, 0.25 is 8192 in 1/32768: q * 659/64 * 1/4.
  CHECK(first_coordinate(constant(10.3f, 0.25), 0) == static_cast<float>(kQ * 659 / 64 * 0.25));
  CHECK(constant(10.3f, 0.25).basis(0, 0) == kQ * 0.25);
  // A mean in binary64 is added before the one rounding to binary32.
  const double mean = 16777216 + 0.5;
  CHECK(first_coordinate(constant(64, 0.25), mean) == static_cast<float>(mean + 8));
}

TEST_CASE("wide values are products in binary32", "[component_sum]") {
  const ComponentSum sum = constant(12345.678f, 0.3);
  REQUIRE(sum.wide_count() == 1);
  const auto basis = static_cast<float>(0.3 * kQ);
  CHECK(sum.basis(4, 0) == static_cast<double>(basis));
  CHECK(first_coordinate(sum, 7) ==
        static_cast<float>(7 + static_cast<double>(basis * 12345.678f)));
}

TEST_CASE("rows go to their vertices, in tiles that are not full", "[component_sum]") {
  constexpr uint32_t kRows = 1537;
  std::mt19937 random(3);
  std::vector<uint32_t> output = identity(kRows);
  std::shuffle(output.begin(), output.end(), random);
  std::vector<float> odd(kRows), even(kRows);
  for (uint32_t r = 0; r < kRows; ++r) {
    odd[r] = static_cast<float>(r % 500);
    even[r] = static_cast<float>(r) * 100;  // wide
  }
  std::vector<double> one(3 * kFrames), two(3 * kFrames);
  for (size_t i = 0; i < one.size(); ++i) {
    one[i] = 0.125 * static_cast<double>(i % 4);
    two[i] = 0.5;
  }
  const ComponentSum sum({even, odd}, {two, one}, kQ, output);
  REQUIRE(sum.wide_count() == 1);
  std::vector<double> mean(3 * kFrames);
  std::iota(mean.begin(), mean.end(), 10.0);
  const size_t stride = 4, frame_stride = kRows * stride + 3;
  std::vector<float> xyz(2 * frame_stride, -1.0f);
  sum.frames(1, 2, mean.data(), xyz.data(), frame_stride, stride);
  for (uint32_t t = 1; t < kFrames; ++t) {
    for (uint32_t r = 0; r < kRows; ++r) {
      for (size_t a = 0; a < 3; ++a) {
        const size_t row = 3 * t + a;
        const double exact = mean[row] + kQ * (0.5 * 100.0 * r + one[row] * (r % 500));
        REQUIRE(xyz[(t - 1) * frame_stride + output[r] * stride + a] ==
                Approx(exact).epsilon(1e-6));
      }
    }
  }
  CHECK(xyz[3] == -1);  // between vertices nothing is written
}

TEST_CASE("a basis beyond binary32 is found", "[component_sum]") {
  CHECK(constant(1, 0.5).finite());
  CHECK_FALSE(constant(1, 1e39).finite());
  CHECK_FALSE(constant(1, std::numeric_limits<double>::infinity()).finite());
}
