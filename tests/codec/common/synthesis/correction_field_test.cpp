#include "codec/common/synthesis/correction_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

constexpr int64_t kMaxSteps = (int64_t{1} << 53) - 1;

using Place = std::tuple<uint32_t, uint32_t, uint32_t>;  // row, frame, axis
using Table = std::map<Place, Correction>;

SurfaceGraph graph_of(const Shape& shape) {
  const std::vector<int32_t> xyz = on_grid(shape, 10);
  return build_surface_graph(GridPoints(xyz), triangles_of(shape.connectivity));
}

std::vector<uint8_t> encode(const PredictionGraph& graph, uint32_t frames, const Table& table) {
  CorrectionField field(graph, frames);
  BinaryEncoder encoder;
  const auto get = [&](uint32_t row, uint32_t t, uint32_t axis) {
    const auto at = table.find({row, t, axis});
    return at == table.end() ? Correction() : at->second;
  };
  CHECK(field.code(encoder, get, [](auto...) { return true; }));
  return encoder.finish();
}

bool same(const Table& a, const Table& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [place, x] : a) {
    const auto at = b.find(place);
    if (at == b.end()) return false;
    const Correction& y = at->second;
    if (x.steps != y.steps || x.replaced != y.replaced) return false;
    if (std::signbit(x.value) != std::signbit(y.value) || x.value != y.value) return false;
  }
  return true;
}

Table decode(const PredictionGraph& graph, uint32_t frames, std::span<const uint8_t> bytes) {
  CorrectionField field(graph, frames);
  BinaryDecoder decoder(bytes);
  Table out;
  const auto none = [](auto...) { return Correction(); };
  field.code(decoder, none, [&](uint32_t row, uint32_t t, uint32_t axis, const Correction& c) {
    out[{row, t, axis}] = c;
    return !decoder.overrun();
  });
  return out;
}

}  // namespace

TEST_CASE("corrections of every size come back", "[corrections]") {
  std::mt19937_64 random(5);
  for (const Shape& shape : {torus(12, 8), with_isolated(tetrahedron(), 3), single_vertex()}) {
    const SurfaceGraph surface = graph_of(shape);
    for (const uint32_t frames : {1u, 2u, 9u}) {
      Table table;
      for (uint32_t row = 0; row < surface.graph.size(); ++row) {
        for (uint32_t i = 0; i < 3 * frames; ++i) {
          if (random() % 4 != 0) continue;
          const auto size = static_cast<int64_t>((random() & kMaxSteps) >> (random() % 53));
          Correction c{random() % 2 == 0 ? size : -size, false, 0};
          if (random() % 9 == 0) c = {0, true, random() % 2 == 0 ? -0.0f : 1e-42f};
          if (!c.none()) table[{row, i / 3, i % 3}] = c;
        }
      }
      table[{0, 0, 0}] = {kMaxSteps, false, 0};
      table[{0, 0, 1}] = {-kMaxSteps, false, 0};
      CHECK(same(decode(surface.graph, frames, encode(surface.graph, frames, table)), table));
    }
  }
}

TEST_CASE("no corrections take a few bytes, clustered ones fewer than scattered", "[corrections]") {
  const SurfaceGraph surface = graph_of(torus(40, 25));
  const uint32_t frames = 30;
  CHECK(encode(surface.graph, frames, {}).size() < 30);

  std::mt19937 random(1);
  Table clustered, scattered;
  for (uint32_t i = 0; i < 3000; ++i) {
    // A few vertices all the time against any vertex at any time.
    clustered[{i % 33, i / 100, 0}] = {1, false, 0};
    scattered[{random() % 1000, random() % frames, random() % 3}] = {random() % 2 ? 1 : -1, false,
                                                                     0};
  }
  CHECK(encode(surface.graph, frames, clustered).size() * 4 <
        encode(surface.graph, frames, scattered).size());
}

TEST_CASE("damaged corrections end", "[corrections]") {
  const SurfaceGraph surface = graph_of(torus(12, 8));
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    std::vector<uint8_t> bytes(random() % 40);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(random());
    for (const auto& [place, c] : decode(surface.graph, 8, bytes)) {
      CHECK(std::get<0>(place) < surface.graph.size());
      CHECK(std::abs(c.steps) <= kMaxSteps);
    }
  }
}

TEST_CASE("a correction moves by whole steps or replaces", "[corrections]") {
  CHECK(Correction{-3, false, 0}.apply(1.0f, 0.25) == 0.25f);
  CHECK(std::signbit(Correction{0, true, -0.0f}.apply(5.0f, 1)));
  // The sum is made in binary64 and rounded once: 2^24 + 1 + 0.5 rounds to 2^24 + 2.
  CHECK(Correction{3, false, 0}.apply(16777216.0f, 0.5) == 16777218.0f);
}

TEST_CASE("corrections of a frame land at their vertices", "[corrections]") {
  Corrections corrections(2, 0.5);
  corrections.add(1, 1, 2, {4, false, 0});
  std::vector<float> xyz(8, 1.0f);
  corrections.apply(0, xyz.data(), 4);
  CHECK(xyz == std::vector<float>(8, 1.0f));
  corrections.apply(1, xyz.data(), 4);
  CHECK(xyz == std::vector<float>{1, 1, 1, 1, 1, 1, 3, 1});
}
