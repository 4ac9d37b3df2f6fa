#include "codec/common/fast/lane_field.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "codec/common/fast/contraction.h"
#include "codec/enc/fields/lane_field_encoder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

SurfaceGraph torus_graph() {
  const Shape shape = torus(30, 20);
  SurfaceGraph surface =
      contract_mesh(shape.connectivity.vertex_count, triangles_of(shape.connectivity));
  weigh_rows(GridPoints(on_grid(shape, 10)), surface);
  return surface;
}

LaneStart torus_start(const SurfaceGraph& surface) {
  return lane_start(surface, GridPoints(on_grid(torus(30, 20), 10)));
}

/// Smooth planes, the later the smaller.
LaneField::Planes smooth_planes(const SurfaceGraph& surface, uint32_t count) {
  LaneField::Planes out(count);
  for (uint32_t k = 0; k < count; ++k) {
    for (const uint32_t v : surface.order)
      out[k].push_back(static_cast<float>(300.0 / (k + 1) * std::sin(0.01 * (k + 1) * v)));
  }
  return out;
}

struct Coded {
  std::vector<uint8_t> section;
  LaneField::Planes planes;
};

Coded encode(const PredictionGraph& graph, LaneField field, const LaneField::Planes& targets,
             double lambda) {
  const SymbolCosts costs = expected_costs();
  LaneFieldEncoder encoder(field, graph, lambda, 0, costs);
  const auto count = static_cast<uint32_t>(targets.size());
  for (uint32_t k = 0, lanes = 0; k < count; k += lanes) {
    lanes = lanes_of_block(k, count);
    encoder.code_block({targets.begin() + k, targets.begin() + k + lanes});
  }
  return {encoder.section(count).finish(), encoder.planes()};
}

}  // namespace

TEST_CASE("a lane field decodes to what its encoder had", "[lane_field]") {
  const SurfaceGraph surface = torus_graph();
  const LaneStart start = torus_start(surface);
  for (const uint32_t count : {1u, 7u, 8u, 9u, 24u, 25u, 40u}) {
    const LaneField::Planes targets = smooth_planes(surface, count);
    const Coded coded = encode(surface.graph, LaneField(surface.graph, start, false), targets, 0.1);
    LaneField field(surface.graph, start, false);
    LaneField::Planes planes;
    REQUIRE(decode_lane_field(coded.section, count, field, planes));
    CHECK(planes == coded.planes);
    double worst = 0;
    for (uint32_t k = 0; k < count; ++k) {
      for (size_t r = 0; r < planes[k].size(); ++r)
        worst = std::max(worst, std::abs(static_cast<double>(planes[k][r] - targets[k][r])));
    }
    CHECK(worst < 2);  // a step, or a little more where bits were saved
  }
}

TEST_CASE("classes follow the magnitudes around", "[lane_field]") {
  const SurfaceGraph surface = torus_graph();
  const std::vector<float> weights = prior_weights(surface.graph);
  LaneField field(surface.graph, weights);
  field.begin_block();
  int32_t n[kRansLanes] = {0, 1, -1, 900, -5000, 2, 0, 7};
  const LaneGuess first = field.guess(0);
  for (uint32_t l = 0; l < kRansLanes; ++l) {
    CHECK(first.prediction[l] == 0.0f);
    CHECK(first.cls[l] == 0);
  }
  field.note(0, first, n);
  // Row 1 goes by row 0: its prediction is row 0's value; the expected magnitude in 1/16 is
  // (10 * 16 m) >> 4, m being row 0's magnitude, capped. What runs along is a row late.
  const LaneGuess second = field.guess(1);
  const auto class_of = [](uint32_t expected) {
    const auto octave = static_cast<uint32_t>(std::floor(std::log2(expected + 1.0)));
    const uint32_t half = (expected + 1) * 2 >= 3u << octave ? 1 : 0;
    return std::min(kRansClasses - 1, 2 * octave + half);
  };
  for (uint32_t l = 0; l < kRansLanes; ++l) {
    CHECK(second.prediction[l] == static_cast<float>(n[l]) * field.step(0));
    const uint32_t m = static_cast<uint32_t>(std::min(255, std::abs(n[l])));
    CHECK(second.cls[l] == class_of(10 * m));
  }
  const int32_t zeros[kRansLanes] = {};
  field.note(1, second, zeros);
  // Row 2 goes by rows 1 and 0, of which row 1 is its ring.
  const LaneGuess third = field.guess(2);
  for (uint32_t l = 0; l < kRansLanes; ++l) {
    const uint32_t m = static_cast<uint32_t>(std::min(255, std::abs(n[l])));
    CHECK(third.cls[l] == class_of(6 * (32 * m >> 4) >> 4));
  }
}

TEST_CASE("cut lane fields are refused", "[lane_field]") {
  const SurfaceGraph surface = torus_graph();
  const std::vector<float> weights = prior_weights(surface.graph);
  const Coded coded =
      encode(surface.graph, LaneField(surface.graph, weights), smooth_planes(surface, 9), 0.1);
  for (size_t size = 0; size < coded.section.size(); size += 1 + size / 20) {
    LaneField field(surface.graph, weights);
    LaneField::Planes planes;
    CHECK_FALSE(decode_lane_field(std::span(coded.section).first(size), 9, field, planes));
  }
}
