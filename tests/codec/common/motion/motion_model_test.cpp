#include "codec/common/motion/motion_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "codec/common/motion/motion_syntax.h"
#include "codec/enc/fields/group_signal.h"
#include "codec/enc/fields/main_group_encoder.h"
#include "codec/enc/motion/motion_fit.h"
#include "codec/enc/reference/surface_context.h"
#include "entropy/range_coder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

SurfaceGraph surface_of(const Shape& shape) {
  const std::vector<int32_t> xyz = on_grid(shape, 12);
  return build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity));
}

uint32_t pick(std::mt19937& random, uint32_t count) {
  return static_cast<uint32_t>(random() % count);
}

MotionModel random_model(const SurfaceGraph& s, uint32_t regions, uint32_t components,
                         std::mt19937& random) {
  MotionModel model(regions, components);
  for (uint32_t row = 0; row < s.graph.size(); ++row) {
    RegionBinding b{pick(random, regions), 0, 0};
    if (row > 0 && random() % 3 > 0) b.primary = model.bindings()[row - 1].primary;
    if (random() % 4 == 0) {
      b.secondary = pick(random, regions);
      b.weight = 1 + pick(random, RegionBinding::kMaxWeight);
    }
    model.bindings().push_back(b);
  }
  for (uint32_t k = 0; k < components; ++k) {
    model.transforms(k).resize(regions);
    if (k % 3 == 1) continue;  // none in this component
    for (MotionModel::Transform& t : model.transforms(k)) {
      for (int32_t& x : t) x = static_cast<int32_t>(random() & 0xFFFFF) >> (random() % 20);
      t[2] = -t[2];
    }
  }
  return model;
}

std::vector<uint8_t> encode(MotionModel& model, const PredictionGraph& graph) {
  BinaryEncoder encoder;
  CHECK(model.code(encoder, graph, 0));
  return encoder.finish();
}

/// Vertices with x < 0 turn about one axis, the others about another one, each part rigidly.
void hinge(const float* rest, double time, double* xyz) {
  const double angle = 1.2 * time * (rest[0] < 0 ? -1 : 1.7);
  const double x = static_cast<double>(rest[0]), y = static_cast<double>(rest[1]);
  const double z = static_cast<double>(rest[2]);
  const double c = std::cos(angle), s = std::sin(angle);
  xyz[0] = rest[0] < 0 ? x : c * x - s * y;
  xyz[1] = rest[0] < 0 ? c * y - s * z : s * x + c * y;
  xyz[2] = rest[0] < 0 ? s * y + c * z : z;
}

}  // namespace

TEST_CASE("the motion section comes back", "[motion_model]") {
  std::mt19937 random(1);
  for (const Shape& shape : small_shapes()) {
    const SurfaceGraph s = surface_of(shape);
    for (const uint32_t regions : {1u, 2u, 7u, 300u}) {
      INFO(shape.name << ", " << regions << " regions");
      MotionModel model = random_model(s, regions, 5, random);
      const auto bytes = encode(model, s.graph);
      BinaryDecoder decoder(bytes);
      MotionModel decoded(regions, 5);
      REQUIRE(decoded.code(decoder, s.graph, 0));
      CHECK_FALSE(decoder.overrun());
      CHECK(decoded.bindings() == model.bindings());
      for (uint32_t k = 0; k < 5; ++k) CHECK(decoded.transforms(k) == model.transforms(k));
    }
  }
}

TEST_CASE("regions that hang together cost little", "[motion_model]") {
  const SurfaceGraph s = surface_of(torus(40, 25));
  MotionModel model(5, 0);
  for (const uint32_t v : s.order) model.bindings().push_back({v * 5 / 1000, 0, 0});
  CHECK(encode(model, s.graph).size() < 145);  // half of log2(5) bits each, outright
}

TEST_CASE("a region that does not exist is refused", "[motion_model]") {
  std::mt19937 random(2);
  const SurfaceGraph s = surface_of(torus(16, 11));
  MotionModel model = random_model(s, 40, 3, random);
  const auto bytes = encode(model, s.graph);
  for (const uint32_t fewer : {1u, 2u, 20u}) {
    BinaryDecoder decoder(bytes);
    MotionModel decoded(fewer, 3);
    CHECK_FALSE(decoded.code(decoder, s.graph, 0));
  }
}

TEST_CASE("damaged motion sections are refused or stay within range", "[motion_model]") {
  std::mt19937 random(3);
  const SurfaceGraph s = surface_of(torus(16, 11));
  MotionModel model = random_model(s, 12, 4, random);
  const auto whole = encode(model, s.graph);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    auto bytes = whole;
    if (round % 2 == 0) bytes.resize(random() % bytes.size());
    if (!bytes.empty()) bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1 + random() % 255);
    BinaryDecoder decoder(bytes);
    MotionModel decoded(12, 4);
    if (!decoded.code(decoder, s.graph, 0) || decoder.overrun()) {
      ++refused;
      continue;
    }
    for (const RegionBinding& b : decoded.bindings()) {
      REQUIRE(b.primary < 12);
      REQUIRE(b.secondary < 12);
      REQUIRE(b.weight <= RegionBinding::kMaxWeight);
    }
  }
  CHECK(refused > 250);
}

TEST_CASE("a prediction is the blend of two affine maps", "[motion_model]") {
  // Four vertices on a line, two a region; centres (50,0,0) and (250,0,0), extents 50.
  const std::vector<int32_t> xyz = {0, 0, 0, 100, 0, 0, 200, 0, 0, 300, 0, 0};
  const std::vector<uint32_t> order = {0, 1, 2, 3};
  MotionModel model(2, 1);
  model.bindings() = {{0, 0, 0}, {0, 1, 4}, {1, 0, 8}, {1, 0, 0}};
  model.transforms(0) = {{4, 0, 0, 10}, {-8, 0, 0, 2}};  // in half units
  model.locate(GridPoints(xyz), order);
  // moved(x, region): 0: 2 (x - 50) / 50 + 5; 1: -4 (x - 250) / 50 + 1
  const auto region0 = [](double x) { return 2 * (x - 50) / 50 + 5; };
  const auto region1 = [](double x) { return -4 * (x - 250) / 50 + 1; };
  const std::vector<float> found = model.predict(0);
  CHECK(found[0] == Approx(region0(0)));
  CHECK(found[1] == Approx(0.75 * region0(100) + 0.25 * region1(100)));
  CHECK(found[2] == Approx(0.5 * region1(200) + 0.5 * region0(200)));
  CHECK(found[3] == Approx(region1(300)));
  std::vector<std::vector<float>> planes = {{1, 1, 1, 1}};
  add_motion(model, planes);
  for (size_t i = 0; i < 4; ++i) CHECK(planes[0][i] == Approx(found[i] + 1));
}

TEST_CASE("rigidly moving parts are predicted to the step of their transforms", "[motion_model]") {
  const Shape shape = torus(30, 16);
  const Shot shot = animate(shape, 15, hinge);
  SurfaceContext surface;
  ReferencePlan plan(shot.connectivity);
  REQUIRE(make_surface_context(shot, plan, 16, {}, surface).ok());
  MainGroupEncoder encoder(make_group_signal(shot, 0, 15), 1);
  const Eigen::MatrixXf targets = encoder.motion_targets(surface);
  std::vector<uint32_t> labels;
  for (size_t i = 0; i < shape.positions.size(); i += 3)
    labels.push_back(shape.positions[i] < 0 ? 0 : 1);
  const MotionFit fit(surface, targets, labels, 2);
  constexpr float kStep = 0.01f;  // coefficients reach some units, the grid has steps of 1e-4
  const auto components = static_cast<uint32_t>(targets.cols());
  const MotionModel model = fit.quantize({kStep, kStep, kStep}, components);
  double largest = 0;
  for (uint32_t k = 0; k < components; ++k) {
    const std::vector<float> predicted = model.predict(k);
    for (uint32_t row = 0; row < surface.rows(); ++row) {
      const double wanted = static_cast<double>(targets(row, k)) / static_cast<double>(kStep);
      largest = std::max(largest, std::abs(wanted));
      // Four entries, each to a quarter unit at factors up to 1, and the grid's rounding.
      REQUIRE(static_cast<double>(predicted[row]) == Approx(wanted).margin(1.1));
    }
  }
  CHECK(largest > 100);
}
