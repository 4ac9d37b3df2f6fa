#include "codec/common/fields/field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "codec/enc/fields/field_encoder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

using Planes = std::vector<std::vector<float>>;

struct Surface {
  std::vector<int32_t> xyz;
  SurfaceGraph graph;

  explicit Surface(const Shape& shape)
      : xyz(on_grid(shape, 12)),
        graph(build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity))) {}
};

/// Smooth waves over the shape plus noise, of falling size.
Planes waves(const Shape& shape, const std::vector<uint32_t>& order, uint32_t count, double size) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Planes out;
  for (uint32_t k = 0; k < count; ++k, size *= 0.6) {
    std::vector<float>& plane = out.emplace_back();
    for (const uint32_t v : order) {
      const double x = static_cast<double>(shape.positions[size_t{v} * 3]);
      const double z = static_cast<double>(shape.positions[size_t{v} * 3 + 2]);
      const double value = size * std::sin(x * (1 + k) + z) + normal(random);
      plane.push_back(static_cast<float>(value));
    }
  }
  return out;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

struct Coded {
  Planes planes;
  std::vector<uint8_t> bytes;
  double squared_error = 0;
};

/// Weights stay those of the reference mesh.
FieldOptions reference_weights() {
  FieldOptions options = surface_field_options();
  options.adaptive = false;
  return options;
}

Coded encode(const Surface& s, const Planes& targets, const FieldOptions& options, double lambda) {
  Field field(s.graph.graph, options, 1);
  field.learn_reference(GridPoints(s.xyz), s.graph.order);
  FieldEncoder encoder(field, s.graph.graph, lambda, 0);
  Coded out;
  for (const auto& target : targets) out.squared_error += encoder.code_component(target.data());
  out.bytes = encoder.recorder().encode(encoder.recorder().size());
  out.planes = field.take_planes();
  return out;
}

Planes decode(const Surface& s, const std::vector<uint8_t>& bytes, size_t count,
              const FieldOptions& options, unsigned threads) {
  Field field(s.graph.graph, options, threads);
  field.learn_reference(GridPoints(s.xyz), s.graph.order);
  BinaryDecoder decoder(bytes);
  for (size_t k = 0; k < count; ++k) {
    field.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
      return field.model().code(decoder, bins, 0);
    });
  }
  CHECK_FALSE(decoder.overrun());
  return field.take_planes();
}

double sum_of_squares(const Planes& a, const Planes& b) {
  double sum = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    for (size_t r = 0; r < a[k].size(); ++r) {
      const double d = static_cast<double>(a[k][r]) - static_cast<double>(b[k][r]);
      sum += d * d;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("a field decodes to the bits that its encoder kept", "[field]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    const Surface s(shape);
    const Planes targets = waves(shape, s.graph.order, 7, 50);
    for (const FieldOptions& options :
         {surface_field_options(), reference_weights(), unpredicted_field_options()}) {
      const Coded coded = encode(s, targets, options, 0.1);
      for (const unsigned threads : {1u, 3u}) {
        const Planes decoded = decode(s, coded.bytes, targets.size(), options, threads);
        REQUIRE(decoded.size() == targets.size());
        for (size_t k = 0; k < decoded.size(); ++k) CHECK(same_bits(decoded[k], coded.planes[k]));
      }
    }
  }
}

TEST_CASE("without rate every value comes back to half its step", "[field]") {
  const Shape shape = torus(20, 15);
  const Surface s(shape);
  const Planes targets = waves(shape, s.graph.order, 5, 200);
  const Coded coded = encode(s, targets, surface_field_options(), 0);
  for (size_t k = 0; k < targets.size(); ++k) {
    for (uint32_t r = 0; r < targets[k].size(); ++r) {
      const double step = kStepTable[s.graph.graph.step_index[r]] / 65536.0;
      const double error =
          static_cast<double>(coded.planes[k][r]) - static_cast<double>(targets[k][r]);
      REQUIRE(std::abs(error) <= 0.5 * step + 1e-3);
    }
  }
  CHECK(coded.squared_error == Approx(sum_of_squares(targets, coded.planes)));
}

TEST_CASE("a higher price of bits gives fewer bytes and more error", "[field]") {
  const Shape shape = torus(20, 15);
  const Surface s(shape);
  const Planes targets = waves(shape, s.graph.order, 5, 20);
  const Coded dear = encode(s, targets, surface_field_options(), 0.3),
              cheap = encode(s, targets, surface_field_options(), 0);
  CHECK(dear.bytes.size() < cheap.bytes.size());
  CHECK(dear.squared_error > cheap.squared_error);
  CHECK(dear.squared_error == Approx(sum_of_squares(targets, dear.planes)));
}

TEST_CASE("learning weights pays on components that move alike", "[field]") {
  const Shape shape = torus(30, 20);
  const Surface s(shape);
  const Planes targets = waves(shape, s.graph.order, 12, 300);
  CHECK(encode(s, targets, surface_field_options(), 0.1).bytes.size() <
        encode(s, targets, reference_weights(), 0.1).bytes.size());
}

TEST_CASE("values far beyond the unary code survive", "[field]") {
  const Shape shape = torus(8, 6);
  const Surface s(shape);
  Planes targets(3, std::vector<float>(48, 0.0f));
  targets[0][5] = 3e6f;
  targets[1][47] = -9e6f;
  targets[2].assign(48, 1e6f);
  const Coded coded = encode(s, targets, surface_field_options(), 0);
  const Planes decoded = decode(s, coded.bytes, 3, surface_field_options(), 1);
  for (size_t k = 0; k < 3; ++k) CHECK(same_bits(decoded[k], coded.planes[k]));
  CHECK(decoded[1][47] == Approx(-9e6f).margin(1));
}

TEST_CASE("values beyond any unit come back to the precision of binary32", "[field]") {
  const Shape shape = torus(8, 6);
  const Surface s(shape);
  Planes targets(4, std::vector<float>(48, 0.25f));
  targets[0][0] = 3.3333333e14f;
  targets[1][47] = -1.234567e12f;
  for (size_t r = 0; r < 48; ++r) targets[2][r] = static_cast<float>(1e13 + 1e12 * std::sin(r));
  const Coded coded = encode(s, targets, surface_field_options(), 0.1);
  const Planes decoded = decode(s, coded.bytes, 4, surface_field_options(), 1);
  for (size_t k = 0; k < 4; ++k) {
    CHECK(same_bits(decoded[k], coded.planes[k]));
    for (size_t r = 0; r < 48; ++r)
      CHECK(decoded[k][r] == Approx(targets[k][r]).epsilon(1e-6).margin(4e7));
  }
}

TEST_CASE("a temporal field decodes to the bits that its encoder kept", "[field]") {
  const TemporalGraph graph = build_temporal_graph(23);
  std::mt19937 random(4);
  Planes targets;
  for (uint32_t k = 0; k < 4; ++k) {
    targets.emplace_back();
    for (const uint32_t at : graph.order)
      targets.back().push_back(
          static_cast<float>(at % 3 + 30 * std::sin(0.1 * (k + 1) * (at / 3))));
  }
  Field field(graph.graph, basis_field_options(), 1);
  FieldEncoder encoder(field, graph.graph, 0.05, 0);
  for (const auto& t : targets) encoder.code_component(t.data());
  const auto bytes = encoder.recorder().encode(encoder.recorder().size());
  Field decoded(graph.graph, basis_field_options(), 2);
  decoded.expect(4);  // learns less, and decodes the same
  BinaryDecoder decoder(bytes);
  for (uint32_t k = 0; k < 4; ++k) {
    decoded.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
      return decoded.model().code(decoder, bins, 0);
    });
    CHECK(same_bits(decoded.plane(k), field.plane(k)));
  }
  CHECK_FALSE(decoder.overrun());
}
