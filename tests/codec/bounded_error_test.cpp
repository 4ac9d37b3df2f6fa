#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "bitstream/container.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

EncodeOptions bounded(double bound) {
  EncodeOptions options = quick_options();
  options.target = Target::kMaxError;
  options.target_value = bound;
  return options;
}

/// The largest error of a coordinate, in long double so that no difference is rounded.
long double largest_error(const Sequence& a, const Sequence& b) {
  long double largest = 0;
  REQUIRE(a.shots.size() == b.shots.size());
  for (size_t s = 0; s < a.shots.size(); ++s) {
    REQUIRE(a.shots[s].positions.size() == b.shots[s].positions.size());
    for (size_t i = 0; i < a.shots[s].positions.size(); ++i) {
      const long double d = static_cast<long double>(a.shots[s].positions[i]) -
                            static_cast<long double>(b.shots[s].positions[i]);
      largest = std::max(largest, std::abs(d));
    }
  }
  return largest;
}

/// Encodes with the bound, decodes, and checks that it holds. Returns the bytes of the file.
size_t check_bound(const Sequence& sequence, const EncodeOptions& options) {
  const Encoded out = encode_or_fail(sequence, options);
  const Sequence decoded = decode_or_fail(out.bytes);
  const long double largest = largest_error(sequence, decoded);
  CHECK(largest <= static_cast<long double>(options.target_value));
  CHECK(out.stats.max_error == Approx(static_cast<double>(largest)).margin(1e-30));
  return out.bytes.size();
}

Sequence moving_torus(uint32_t around, uint32_t across, uint32_t frames) {
  return sequence_of({animate(torus(around, across), frames)});
}

size_t check_bound(const Sequence& sequence, double bound) {
  return check_bound(sequence, bounded(bound));
}

}  // namespace

TEST_CASE("no coordinate misses the bound, and tighter ones cost more", "[bounded]") {
  const Sequence sequence = large_sequence();
  size_t before = 0;
  for (const double bound : {1e-1, 1e-3, 1e-5}) {
    const size_t bytes = check_bound(sequence, bound);
    CHECK(bytes > before);
    before = bytes;
  }
}

TEST_CASE("corrections beat a reconstruction that meets the bound by itself", "[bounded]") {
  const Sequence sequence = large_sequence();
  const Encoded out = encode_or_fail(sequence, bounded(1e-3));
  // What the base alone would have to reach: a finer KG target whose largest error is the bound.
  EncodeOptions plain = quick_options();
  plain.target_value = out.stats.kg;
  const Encoded same_kg = encode_or_fail(sequence, plain);
  CHECK(same_kg.stats.max_error > 1e-3);
}

TEST_CASE("the bound holds in every profile", "[bounded]") {
  const Sequence sequence = moving_torus(16, 10, 6);
  for (const Profile profile : {Profile::kFast, Profile::kThesis}) {
    EncodeOptions options = bounded(1e-3);
    options.profile = profile;
    check_bound(sequence, options);
  }
}

TEST_CASE("the bound holds far from the origin, where binary32 has no finer values", "[bounded]") {
  Sequence sequence = moving_torus(12, 8, 5);
  for (float& x : sequence.shots[0].positions) x = 1e6f + x;
  for (const double bound : {1.0, 0.1, 0.06, 0.03, 1e-4}) check_bound(sequence, bound);
}

TEST_CASE("the bound holds on tiny and on subnormal details", "[bounded]") {
  Sequence sequence = moving_torus(12, 8, 5);
  for (const float scale : {1e-20f, 1e-40f}) {
    Sequence tiny = sequence;
    for (float& x : tiny.shots[0].positions) x *= scale;
    check_bound(tiny, 1e-4 * static_cast<double>(scale));
  }
}

TEST_CASE("the bound holds with one frame far away", "[bounded]") {
  Sequence sequence = moving_torus(12, 8, 7);
  const size_t frame = sequence.shots[0].frame(0).size();
  for (const float scale : {1e8f, 1e30f}) {
    Sequence far = sequence;
    for (size_t i = 3 * frame; i < 4 * frame; ++i) far.shots[0].positions[i] *= scale;
    check_bound(far, 1e-3);
  }
}

TEST_CASE("an outlier costs its own corrections and no more", "[bounded]") {
  const Sequence sequence = moving_torus(32, 20, 12);
  const size_t frame = sequence.shots[0].frame(0).size();
  const size_t plain = check_bound(sequence, 1e-4);
  for (const float distance : {1e4f, 1e7f}) {
    Sequence vertex = sequence;  // one vertex in all frames
    for (size_t t = 0; t < 12; ++t) vertex.shots[0].positions[t * frame + 300] += distance;
    // 32 bits for each of its coordinates, and something for the shape of the neighbourhood.
    CHECK(check_bound(vertex, 1e-4) < plain + plain / 10 + 12 * 4);
    Sequence glitch = sequence;  // in one frame
    glitch.shots[0].positions[5 * frame + 300] = distance;
    CHECK(check_bound(glitch, 1e-4) < plain + plain / 20 + 12);
  }
}

TEST_CASE("the bound holds with coordinates of very different sizes", "[bounded]") {
  Sequence sequence = moving_torus(12, 8, 7);
  std::mt19937 random(7);
  for (float& x : sequence.shots[0].positions) {
    x = std::ldexp(x, static_cast<int>(random() % 60) - 30);
  }
  for (const double bound : {1e2, 1e-6}) check_bound(sequence, bound);
}

TEST_CASE("frames that are equal cost next to nothing", "[bounded]") {
  const Sequence one = moving_torus(24, 16, 1);
  Sequence still = one;
  still.shots[0].frame_count = 100;
  for (int i = 1; i < 100; ++i) {
    still.shots[0].positions.insert(still.shots[0].positions.end(), one.shots[0].positions.begin(),
                                    one.shots[0].positions.end());
  }
  const size_t single = check_bound(one, 1e-4);
  CHECK(check_bound(still, 1e-4) < single + 250);

  // Noise far below the bound is not coded.
  std::mt19937 random(3);
  for (float& x : still.shots[0].positions)
    x += 1e-16f * static_cast<float>(static_cast<int>(random() % 3) - 1);
  CHECK(check_bound(still, 1e-4) < single + 250);
}

TEST_CASE("a bound above the size of everything keeps little", "[bounded]") {
  CHECK(check_bound(moving_torus(24, 16, 20), 100.0) < check_bound(moving_torus(24, 16, 20), 0.01));
}

TEST_CASE("a bound below the precision of the input gives the input", "[bounded]") {
  check_bound(moving_torus(12, 8, 4), 1e-15);
}

TEST_CASE("erratic motion is snapped to a grid, which is smaller", "[bounded]") {
  Sequence sequence = moving_torus(16, 10, 12);
  std::mt19937 random(11);
  for (float& x : sequence.shots[0].positions)
    x += 1e-3f * static_cast<float>(static_cast<int>(random() % 2001) - 1000);
  const size_t bytes = check_bound(sequence, 0.01);
  // Noise of +-1 on multiples of 0.02 is some log2(100) bits a coordinate.
  CHECK(static_cast<double>(bytes) <
        7.5 / 8 * static_cast<double>(sequence.shots[0].positions.size()) + 1000);
  ContainerReader container;
  const Encoded out = encode_or_fail(sequence, bounded(0.01));
  REQUIRE(container.parse(out.bytes, {}).ok());
  CHECK(container.groups[0].header.profile == Profile::kLossless);
}

TEST_CASE("one vertex, one frame", "[bounded]") {
  Sequence sequence;
  Shot& shot = sequence.shots.emplace_back();
  shot.connectivity.vertex_count = 1;
  shot.frame_count = 1;
  shot.positions = {0.1f, -1e7f, std::numeric_limits<float>::denorm_min()};
  check_bound(sequence, 1e-3);
}
