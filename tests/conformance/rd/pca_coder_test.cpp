#include "conformance/rd/peers/pca_coder.h"

#include <catch2/catch.hpp>
#include <random>

namespace reeb::conformance {
namespace {

constexpr uint32_t kSide = 20;

/// A square of 20 x 20 vertices.
Traversal square() {
  std::vector<uint32_t> triangles;
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t v = y * kSide + x;
      triangles.insert(triangles.end(), {v, v + 1, v + kSide, v + 1, v + kSide + 1, v + kSide});
    }
  }
  return traverse(triangles, kSide * kSide);
}

std::vector<double> smooth() {
  std::vector<double> values;
  for (uint32_t v = 0; v < kSide * kSide; ++v)
    values.push_back(3.0 * (v % kSide) + 40.0 * (v / kSide));
  return values;
}

TEST_CASE("coefficients and trajectories come back as the encoder has them") {
  const Traversal traversal = square();
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 30);
  std::vector<double> coefficients(kSide * kSide), trajectory(60);
  for (double& c : coefficients) c = noise(random);
  for (double& c : trajectory) c = noise(random);
  for (const auto prediction :
       {SurfacePrediction::kParallelogram, SurfacePrediction::kMean, SurfacePrediction::kNone}) {
    const auto order = static_cast<uint32_t>(prediction);
    PcaCoder coder(traversal);
    BinaryEncoder encoder;
    std::vector<double> coded = coefficients, coded_trajectory = trajectory;
    coder.code_coefficients(encoder, prediction, coded);
    coder.code_trajectory(encoder, order, coded_trajectory);
    for (size_t i = 0; i < coded.size(); ++i)
      REQUIRE(std::abs(coded[i] - coefficients[i]) <= 0.5 + 1e-9);
    for (size_t i = 0; i < trajectory.size(); ++i)
      REQUIRE(std::abs(coded_trajectory[i] - trajectory[i]) <= 0.5 + 1e-9);

    const std::vector<uint8_t> bytes = encoder.finish();
    PcaCoder same(traversal);
    BinaryDecoder decoder(bytes);
    std::vector<double> decoded(coefficients.size()), decoded_trajectory(trajectory.size());
    same.code_coefficients(decoder, {}, decoded);
    same.code_trajectory(decoder, 0, decoded_trajectory);
    CHECK(decoded == coded);
    CHECK(decoded_trajectory == coded_trajectory);
  }
}

TEST_CASE("a plane costs next to nothing by parallelograms") {
  const Traversal traversal = square();
  const auto bits_with = [&](SurfacePrediction prediction) {
    PcaCoder coder(traversal);
    BitCounter counter;
    std::vector<double> values = smooth();
    coder.code_coefficients(counter, prediction, values);
    return counter.bits();
  };
  CHECK(bits_with(SurfacePrediction::kParallelogram) < kSide * kSide);
  CHECK(bits_with(SurfacePrediction::kNone) > 8 * kSide * kSide);
}

TEST_CASE("counted bits are what the coder writes") {
  const Traversal traversal = square();
  PcaCoder one(traversal), two(traversal);
  BitCounter counter;
  BinaryEncoder encoder;
  std::vector<double> a = smooth(), b = a;
  one.code_coefficients(counter, SurfacePrediction::kMean, a);
  two.code_coefficients(encoder, SurfacePrediction::kMean, b);
  const auto bytes = static_cast<double>(encoder.finish().size());
  CHECK(8 * bytes == Approx(counter.bits()).epsilon(0.01).margin(24));
}

TEST_CASE("a steady motion is extrapolated") {
  const std::vector<double> values = {0, 5, 9, 10, 5, 8, 20, 5, 7};
  CHECK(PcaCoder::extrapolate(0, 8, values) == 0);
  CHECK(PcaCoder::extrapolate(1, 8, values) == 8);
  CHECK(PcaCoder::extrapolate(2, 8, values) == 7);
  CHECK(PcaCoder::extrapolate(2, 5, values) == 9);
  CHECK(PcaCoder::extrapolate(2, 2, values) == 0);
}

}  // namespace
}  // namespace reeb::conformance
