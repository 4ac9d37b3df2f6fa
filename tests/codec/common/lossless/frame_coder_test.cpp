#include "codec/common/lossless/frame_coder.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>

#include "entropy/range_coder.h"
#include "entropy/raw_bits.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

using Frames = std::vector<std::vector<float>>;

struct Scene {
  SurfaceGraph surface;
  std::vector<float> start;

  explicit Scene(const Shape& shape) {
    const std::vector<int32_t> grid = on_grid(shape, 10);
    surface = build_surface_graph(GridPoints(grid), triangles_of(shape.connectivity));
    for (const uint32_t v : surface.order)
      start.insert(start.end(), &shape.positions[3 * v], &shape.positions[3 * v] + 3);
  }
};

struct Coded {
  std::vector<uint8_t> bits, raw;
  std::vector<size_t> raw_bytes;  ///< after each frame, roughly
};

Coded encode(const Scene& scene, const Frames& frames, const NumberSets& sets, bool quick) {
  BinaryEncoder bits;
  RawBitWriter raw;
  FrameCoder coder(scene.surface.graph, scene.start, sets, quick, 1);
  for (std::vector<float> frame : frames) CHECK(coder.code(bits, raw, frame.data()));
  return {bits.finish(), raw.finish(), {}};
}

bool decodes_to(const Scene& scene, const Coded& coded, const Frames& frames,
                const NumberSets& sets, bool quick) {
  BinaryDecoder bits(coded.bits);
  RawBitReader raw(coded.raw);
  FrameCoder coder(scene.surface.graph, scene.start, sets, quick, 1);
  for (const std::vector<float>& frame : frames) {
    std::vector<float> out(frame.size());
    if (!coder.code(bits, raw, out.data())) return false;
    if (std::memcmp(out.data(), frame.data(), frame.size() * sizeof(float)) != 0) return false;
  }
  return !bits.overrun() && raw.at_end();
}

/// Everything moves by the same vector each frame.
Frames drift(const Scene& scene, uint32_t count, float step) {
  Frames out;
  for (uint32_t t = 0; t < count; ++t) {
    std::vector<float>& frame = out.emplace_back(scene.start);
    for (float& x : frame) x += step * static_cast<float>(t);
  }
  return out;
}

}  // namespace

TEST_CASE("frames come back to the bit, whatever the values", "[frame_coder]") {
  std::mt19937 random(5);
  for (const Shape& shape : {torus(9, 6), points_only(20), single_vertex()}) {
    const Scene scene(shape);
    Frames frames = drift(scene, 4, 0.37f);
    for (float& x : frames[2]) {  // any bits that are a number
      auto bits = static_cast<uint32_t>(random());
      if ((bits & 0x7F800000) == 0x7F800000) bits &= 0x80FFFFFF;
      std::memcpy(&x, &bits, sizeof x);
    }
    frames[3][0] = -0.0f;
    for (const bool quick : {false, true}) {
      for (const NumberSet& set : {NumberSet(), NumberSet(6, 3), NumberSet::multiples(0.125)}) {
        const NumberSets sets = {set, NumberSet(), set};
        CHECK(decodes_to(scene, encode(scene, frames, sets, quick), frames, sets, quick));
      }
    }
  }
}

TEST_CASE("what stands still costs less than a bit a hundred vertices", "[frame_coder]") {
  const Scene scene(torus(30, 20));
  const Frames still(60, scene.start);
  const size_t one = encode(scene, {scene.start}, {}, false).bits.size();
  const Coded all = encode(scene, still, {}, false);
  CHECK(all.raw.empty());
  CHECK((all.bits.size() - one) * 8 < 59 * 600 / 100);
}

TEST_CASE("a steady motion of multiples is predicted exactly, once it is known", "[frame_coder]") {
  Scene scene(torus(30, 20));
  for (float& x : scene.start) x = std::round(x * 64) / 64;
  const NumberSets sets = {NumberSet::multiples(1.0 / 64), NumberSet::multiples(1.0 / 64),
                           NumberSet::multiples(1.0 / 64)};
  const auto bytes = [&](uint32_t count) {
    const Coded coded = encode(scene, drift(scene, count, 0.25f), sets, false);
    return coded.bits.size() + coded.raw.size();
  };
  const size_t ten = bytes(10);
  // Three coordinates a vertex for a tenth of a bit each.
  CHECK((bytes(60) - ten) * 8 < 50 * 600 * 3 / 10);
}

TEST_CASE("a copy of an earlier frame is gone on from", "[frame_coder]") {
  const Scene scene(torus(12, 8));
  const Frames frames = drift(scene, 6, 0.5f);
  const auto size_of_last = [&](bool jumps) {
    BinaryEncoder bits;
    RawBitWriter raw;
    FrameCoder coder(scene.surface.graph, scene.start, {}, false, 1);
    for (std::vector<float> frame : frames) coder.code(bits, raw, frame.data());
    const double before = static_cast<double>(raw.finish().size());
    if (jumps) coder.jump(frames[1]);
    RawBitWriter rest;
    std::vector<float> again = frames[1];
    coder.code(bits, rest, again.data());
    return before + static_cast<double>(rest.finish().size());
  };
  CHECK(size_of_last(true) < size_of_last(false));
}

TEST_CASE("no decoder takes a number that is not finite, or none of the set", "[frame_coder]") {
  const Scene scene(single_vertex());
  BinaryEncoder bits;
  RawBitWriter raw;
  RankModel model;
  DifferenceContext c;
  AdaptiveBit still;
  still.code(bits, false, 1000);
  // The coder's own first context, so that the escape is read as one.
  DifferenceHistory history(scene.surface.graph);
  history.open_row(0);
  const NumberSet set;
  const int64_t guess = set.nearest(static_cast<double>(scene.start[0]));
  c = history.context(0, 0, set.spacing(guess), true);
  int64_t n = 0;
  CHECK_FALSE(model.code(bits, raw, c, true, n));
  raw.code(0x7F800000, 32);  // infinity
  const std::vector<uint8_t> code = bits.finish(), rest = raw.finish();
  BinaryDecoder in(code);
  RawBitReader raw_in(rest);
  FrameCoder coder(scene.surface.graph, scene.start, {}, false, 1);
  float frame[3];
  CHECK_FALSE(coder.code(in, raw_in, frame));
}
