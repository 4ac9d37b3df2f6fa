// Lossless coding through the public interfaces: every bit comes back, and what does not move costs
// next to nothing.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "codec/enc/lossless/stream_encoder.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

EncodeOptions lossless_options() {
  EncodeOptions options;
  options.target = Target::kLossless;
  options.threads = 1;
  return options;
}

Bytes check_round_trip(const Sequence& sequence, const EncodeOptions& options) {
  Bytes bytes = encode_or_fail(sequence, options).bytes;
  const Sequence decoded = decode_or_fail(bytes);
  CHECK(same_positions(sequence, decoded));
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    CHECK(decoded.shots[i].frame_count == sequence.shots[i].frame_count);
    CHECK(decoded.shots[i].connectivity == sequence.shots[i].connectivity);
  }
  return bytes;
}

Bytes check_round_trip(const Sequence& sequence) {
  return check_round_trip(sequence, lossless_options());
}

/// A torus whose coordinates `value` makes out of its own ones.
template <class Value>
Sequence torus_of(uint32_t frames, Value value) {
  Sequence out = sequence_of({animate(torus(12, 8), frames)});
  for (float& x : out.shots[0].positions) x = value(x);
  return out;
}

double rounded(double x, double unit) { return std::round(x / unit) * unit; }

}  // namespace

TEST_CASE("lossless coding keeps every shape to the bit", "[lossless]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    check_round_trip(sequence_of({animate(shape, 7)}));
  }
  check_round_trip(
      sequence_of({animate(torus(8, 6), 6), animate(mixed_polygons(), 1), animate(fins(7), 3)}));
}

TEST_CASE("lossless coding keeps numbers of any kind", "[lossless]") {
  std::mt19937 random(7);
  const auto any = [&] {
    for (;;) {
      const auto x = std::bit_cast<float>(static_cast<uint32_t>(random()));
      if (std::isfinite(x)) return x;
    }
  };
  SECTION("any bits") {
    check_round_trip(torus_of(5, [&](float) { return any(); }));
  }
  SECTION("zeros of both signs, the smallest and the largest numbers") {
    constexpr float kSome[] = {0.0f,
                               -0.0f,
                               std::numeric_limits<float>::denorm_min(),
                               -std::numeric_limits<float>::denorm_min(),
                               std::numeric_limits<float>::min(),
                               std::numeric_limits<float>::max(),
                               std::numeric_limits<float>::lowest(),
                               1.0f};
    check_round_trip(torus_of(9, [&](float) { return kSome[random() % std::size(kSome)]; }));
    check_round_trip(torus_of(3, [&](float x) { return x > 0 ? 3e38f : -3e38f; }));
  }
  SECTION("one wild value in a calm sequence") {
    check_round_trip(torus_of(9, [&](float x) { return random() % 500 == 0 ? any() : x; }));
  }
  SECTION("far from the origin, and tiny") {
    check_round_trip(torus_of(6, [](float x) { return 1e7f + x; }));
    check_round_trip(torus_of(6, [](float x) { return x * 1e-42f; }));
  }
}

TEST_CASE("lossless coding refuses what is no number", "[lossless]") {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Sequence sequence = sequence_of({animate(tetrahedron(), 3)});
    sequence.shots[0].positions[20] = bad;
    Bytes bytes;
    EncodeStats stats;
    const Status status = encode(sequence, lossless_options(), bytes, stats);
    CHECK(status.code() == StatusCode::kInvalidArgument);
    CHECK(status.message().find("not finite") != std::string::npos);
    CHECK(bytes.empty());
  }
}

TEST_CASE("lossless coding finds decimals", "[lossless]") {
  const auto decimal = [](float x) {
    return static_cast<float>(rounded(static_cast<double>(x), 1e-3));
  };
  const Sequence fixed = torus_of(30, decimal);
  const size_t full = check_round_trip(torus_of(30, [](float x) { return x; })).size();
  const size_t coarse = check_round_trip(fixed).size();
  // binary32 near 2 is 2^-22 apart: 12 bits finer than thousandths, some of which are predicted
  // anyway.
  const double saved = 8.0 * (static_cast<double>(full) - static_cast<double>(coarse));
  CHECK(saved > 6.0 * static_cast<double>(fixed.shots[0].positions.size()));

  SECTION("six significant digits") {
    const auto digits = [](float x) {
      const int exponent = x == 0.0f ? 0 : static_cast<int>(std::floor(std::log10(std::abs(x))));
      const double unit = std::pow(10.0, exponent - 5);
      return static_cast<float>(rounded(static_cast<double>(x), unit));
    };
    const size_t six = check_round_trip(torus_of(30, digits)).size();
    CHECK(six < full);
  }
  SECTION("negative zeros and a few strangers") {
    Sequence mixed = fixed;
    std::vector<float>& x = mixed.shots[0].positions;
    for (size_t i = 0; i < x.size(); i += 50) x[i] = -0.0f;
    const size_t zeros = check_round_trip(mixed).size();
    x[1001] = 0.123456789f;
    const size_t strange = check_round_trip(mixed).size();
    CHECK(strange < zeros + 60);
  }
}

TEST_CASE("what does not move costs next to nothing", "[lossless]") {
  const auto size_of = [](const Shape& shape, uint32_t frames, const Motion& motion) {
    return check_round_trip(sequence_of({animate(shape, frames, motion)})).size();
  };
  SECTION("a still sequence of 1,000 frames") {
    const Shape shape = torus(24, 14);
    CHECK(size_of(shape, 1000, rest) < size_of(shape, 1, rest) + 60);
  }
  SECTION("a sequence that repeats after 24 frames") {
    Shot shot = animate(torus(24, 14), 24);
    const size_t once = check_round_trip(sequence_of({shot})).size();
    const std::vector<float> cycle = shot.positions;
    for (int i = 0; i < 9; ++i)
      shot.positions.insert(shot.positions.end(), cycle.begin(), cycle.end());
    shot.frame_count *= 10;
    CHECK(check_round_trip(sequence_of({shot})).size() < once + 60);
  }
  SECTION("one moving component among fifty") {
    Shape all;
    for (int i = 0; i < 50; ++i) {
      const Shape one = torus(10, 6);
      const auto first = static_cast<uint32_t>(all.positions.size() / 3);
      for (size_t v = 0; v < one.positions.size(); v += 3) {
        all.add_vertex(one.positions[v] + 9.0f * static_cast<float>(i), one.positions[v + 1],
                       one.positions[v + 2]);
      }
      for (size_t c = 0; c < one.connectivity.corners.size(); c += 3) {
        const uint32_t* corner = &one.connectivity.corners[c];
        all.add_face({first + corner[0], first + corner[1], first + corner[2]});
      }
    }
    const Motion first_moves = [](const float* at, double time, double* xyz) {
      (at[0] < 4.5f ? bend : rest)(at, time, xyz);
    };
    const uint32_t frames = 40;
    const size_t moving = size_of(torus(10, 6), frames, bend);
    const size_t still = size_of(all, 1, rest);
    const double rest_bits = 0.02 * 49 * 60 * (frames - 1);
    CHECK(static_cast<double>(size_of(all, frames, first_moves)) <
          static_cast<double>(still) + 1.05 * static_cast<double>(moving) + rest_bits / 8);
  }
}

TEST_CASE("lossless groups decode alone and do not depend on threads", "[lossless]") {
  const Sequence sequence = sequence_of({animate(torus(16, 11), 23)});
  EncodeOptions options = lossless_options();
  options.group_length = 5;
  const Bytes bytes = check_round_trip(sequence, options);
  options.threads = 3;
  CHECK(encode_or_fail(sequence, options).bytes == bytes);
  CHECK(same_positions(decode_or_fail(bytes, 3), sequence));
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  REQUIRE(decoder->info().groups.size() == 5);
  std::vector<float> xyz(176 * 4, 7.0f);
  for (const uint32_t t : {22u, 3u, 4u, 5u, 17u, 0u}) {
    REQUIRE(decoder->decode_frame(t, xyz.data(), 4).ok());
    bool same = true;
    for (uint32_t i = 0; i < 176 * 3; ++i)
      same = same && xyz[i / 3 * 4 + i % 3] == sequence.shots[0].frame(t)[i];
    CHECK(same);
    CHECK(xyz[3] == 7.0f);
  }
}

TEST_CASE("the quick method keeps every bit, too", "[lossless]") {
  std::mt19937 random(8);
  EncodeOptions options = lossless_options();
  options.effort = 1;
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    check_round_trip(sequence_of({animate(shape, 20)}), options);
  }
  check_round_trip(torus_of(9,
                            [&](float) {
                              const auto x = std::bit_cast<float>(static_cast<uint32_t>(random()));
                              return std::isfinite(x) ? x : -0.0f;
                            }),
                   options);
  const Sequence smooth = sequence_of({animate(torus(24, 14), 30)});
  const size_t quick = check_round_trip(smooth, options).size();
  const size_t usual = check_round_trip(smooth).size();
  CHECK(usual < quick);
  CHECK(quick < 12 * 336 * 30 * 6 / 10);
}

TEST_CASE("frames are encoded as they arrive", "[lossless]") {
  const Shot shot = animate(torus(12, 8), 10);
  Bytes bytes;
  size_t calls = 0;
  const auto sink = [&](std::span<const uint8_t> part) {
    bytes.insert(bytes.end(), part.begin(), part.end());
    return ++calls < 1000;
  };
  SequenceHeader header;
  header.total_frames = 1000;
  header.flags = SequenceHeader::kOpenEnded;
  StreamEncoder encoder({.group_length = 3, .threads = 1}, sink);
  REQUIRE(encoder.begin(header, {}).ok());
  REQUIRE(encoder.begin_shot(shot.connectivity).ok());
  for (uint32_t t = 0; t < 10; ++t) {
    REQUIRE(encoder.add_frame(shot.frame(t)).ok());
    CHECK(encoder.bytes() == bytes.size());
    // What is there already decodes: all groups but the one in hand.
    Sequence so_far;
    CHECK(decode_sequence(bytes, {}, so_far).ok());
    CHECK((so_far.shots.empty() ? 0 : so_far.shots[0].frame_count) == (t + 1) / 3 * 3);
  }
  REQUIRE(encoder.finish().ok());
  const Sequence decoded = decode_or_fail(bytes);
  CHECK(same_positions(decoded, sequence_of({shot})));
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  CHECK_FALSE(decoder->info().truncated);
  CHECK(decoder->info().frame_count == 10);
  DecodeOptions few;
  few.limits.max_frames = 9;
  CHECK(Decoder::open(bytes, few, decoder).code() == StatusCode::kLimitExceeded);
}

TEST_CASE("the stream encoder says what is wrong", "[lossless]") {
  const Shot shot = animate(tetrahedron(), 2);
  const auto nowhere = [](std::span<const uint8_t>) { return false; };
  const auto anywhere = [](std::span<const uint8_t>) { return true; };
  StreamEncoder full({.threads = 1}, nowhere);
  CHECK(full.begin({}, {}).code() == StatusCode::kIo);
  StreamEncoder early({.threads = 1}, anywhere);
  REQUIRE(early.begin({}, {}).ok());
  CHECK(early.add_frame(shot.frame(0)).code() == StatusCode::kInvalidArgument);
  REQUIRE(early.begin_shot(shot.connectivity).ok());
  CHECK(early.add_frame(shot.frame(0).first(9)).code() == StatusCode::kInvalidArgument);
  std::vector<float> bad(12, 0.0f);
  bad[5] = std::numeric_limits<float>::infinity();
  CHECK(early.add_frame(bad).code() == StatusCode::kInvalidArgument);
}

TEST_CASE("the order of vertices can be dropped", "[lossless]") {
  const Sequence sequence = sequence_of({animate(torus(16, 11), 4)});
  EncodeOptions options = lossless_options();
  options.reorder = true;
  const Bytes bytes = encode_or_fail(sequence, options).bytes;
  CHECK(bytes.size() < encode_or_fail(sequence, lossless_options()).bytes.size());
  const Sequence decoded = decode_or_fail(bytes);
  using Places = std::multiset<std::array<float, 3>>;
  const auto places = [](std::span<const float> xyz) {
    Places out;
    for (size_t i = 0; i < xyz.size(); i += 3) out.insert({xyz[i], xyz[i + 1], xyz[i + 2]});
    return out;
  };
  for (uint32_t t = 0; t < 4; ++t)
    CHECK(places(decoded.shots[0].frame(t)) == places(sequence.shots[0].frame(t)));
}

TEST_CASE("frames on grids of their own cost what their levels do", "[lossless]") {
  // 256 levels an axis, with a step and an origin for each frame and axis, in binary32 arithmetic.
  constexpr uint32_t kFrames = 12;
  Sequence sequence = sequence_of({animate(torus(40, 25), kFrames)});
  Shot& shot = sequence.shots[0];
  const size_t size = shot.frame(0).size();
  for (uint32_t t = 0; t < kFrames; ++t) {
    for (size_t a = 0; a < 3; ++a) {
      float low = shot.positions[t * size + a], high = low;
      for (size_t i = t * size + a; i < (t + 1) * size; i += 3) {
        low = std::min(low, shot.positions[i]);
        high = std::max(high, shot.positions[i]);
      }
      const float step = (high - low) / 255;
      for (size_t i = t * size + a; i < (t + 1) * size; i += 3) {
        const float scaled = std::round((shot.positions[i] - low) / step) * step;
        shot.positions[i] = scaled + low;
      }
    }
  }
  for (const int effort : {1, 5}) {
    EncodeOptions options = lossless_options();
    options.effort = effort;
    const Bytes bytes = check_round_trip(sequence, options);
    const double bits = 8.0 * static_cast<double>(bytes.size()) / (1000.0 * kFrames);
    CHECK(bits < 24);
  }

  // Levels at random, which nothing foretells: 24 bits, and little for the grids, the mesh and what
  // is tried. The second time all grids are parts of a fine one, which takes twice as much.
  for (const bool rounded : {true, false}) {
    std::mt19937 random(11);
    for (size_t i = 0; i < shot.positions.size(); ++i) {
      const auto t = static_cast<float>(i / size);
      const float step = rounded ? 0.01f + 0.001f * t : (40 + t) / 64;
      shot.positions[i] = static_cast<float>(random() % 256) * step + t;
    }
    const Bytes bytes = check_round_trip(sequence);
    const double bits = 8.0 * static_cast<double>(bytes.size()) / (1000.0 * kFrames);
    INFO(rounded << ": " << bits);
    CHECK(bits < 27);
  }
}
