// Targets that only a lossless coding meets, or that it meets with fewer bytes.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

EncodeOptions aiming(Target target, double value) {
  EncodeOptions options;
  options.target = target;
  options.target_value = value;
  options.effort = 4;
  return options;
}

size_t lossless_size(const Sequence& sequence) {
  return encode_or_fail(sequence, aiming(Target::kLossless, 1)).bytes.size();
}

Errors errors_of(const Sequence& sequence, const Encoded& encoded) {
  return measure(sequence, decode_or_fail(encoded.bytes));
}

Sequence bending(uint32_t frames = 12) { return sequence_of({animate(torus(18, 12), frames)}); }

/// Whole numbers of sixteenths, far from the origin: binary32 holds no more there.
Sequence georeferenced() {
  Sequence out = bending(10);
  for (float& x : out.shots[0].positions) x = 500000 + std::round(x * 16) / 16;
  return out;
}

}  // namespace

TEST_CASE("a frame or a vertex far away puts no target out of reach", "[exact_targets]") {
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    EncodeOptions options = aiming(Target::kKg, 0.05);
    options.profile = profile;
    Sequence frame = bending();
    const size_t size = frame.shots[0].connectivity.vertex_count * size_t{3};
    for (size_t i = 4 * size; i < 5 * size; ++i) frame.shots[0].positions[i] += 1e6f;
    const Encoded far_frame = encode_or_fail(frame, options);
    CHECK(errors_of(frame, far_frame).kg <= 0.05);
    for (const std::string& note : far_frame.stats.notes)
      CHECK(note.find("hardly count") == note.npos);  // each frame has a mean of its own
    Sequence vertex = bending();
    vertex.shots[0].positions[7 * size + 30] = 1e8f;
    const Encoded far_vertex = encode_or_fail(vertex, options);
    CHECK(errors_of(vertex, far_vertex).kg <= 0.05);
    REQUIRE(far_vertex.stats.notes.size() == 1);
    const bool exact = far_vertex.stats.max_error == 0;
    CHECK(far_vertex.stats.notes[0].find(exact ? "lossless" : "hardly count") != std::string::npos);
  }
}

TEST_CASE("errors below what reconstruction can reach end in no error", "[exact_targets]") {
  const Sequence sequence = bending();
  const size_t exact = lossless_size(sequence);
  for (const EncodeOptions& options :
       {aiming(Target::kKg, 1e-12), aiming(Target::kKg, 0), aiming(Target::kMaxError, 1e-30),
        aiming(Target::kMaxError, 1e-300), aiming(Target::kMaxError, 0)}) {
    const Encoded out = encode_or_fail(sequence, options);
    CHECK(out.bytes.size() <= exact);
    CHECK(out.stats.kg == 0);
    CHECK(same_positions(sequence, decode_or_fail(out.bytes)));
  }
  const Encoded fine = encode_or_fail(sequence, aiming(Target::kKg, 1e-5));
  CHECK(errors_of(sequence, fine).kg <= 1e-5);
  EncodeOptions fast = aiming(Target::kKg, 1e-12);
  fast.profile = Profile::kFast;
  const Encoded out = encode_or_fail(sequence, fast);
  CHECK(out.stats.notes.size() == 1);
  CHECK(same_positions(sequence, decode_or_fail(out.bytes)));
}

TEST_CASE("no target takes more than a lossless coding", "[exact_targets]") {
  const Sequence sequence = georeferenced();
  const size_t exact = lossless_size(sequence);
  for (const EncodeOptions& options :
       {aiming(Target::kKg, 0.05), aiming(Target::kMaxError, 0.01),
        aiming(Target::kSize, 1.5 * static_cast<double>(exact)),
        aiming(Target::kBpvf, 9 * static_cast<double>(exact) / vertex_frames(sequence))}) {
    const Encoded out = encode_or_fail(sequence, options);
    CHECK(out.bytes.size() <= exact);
    CHECK(same_positions(sequence, decode_or_fail(out.bytes)));
    CHECK(out.stats.notes.size() == 1);
  }
}

TEST_CASE("a coding with a loss stays where it is smaller", "[exact_targets]") {
  const Sequence sequence = bending();
  const Encoded out = encode_or_fail(sequence, aiming(Target::kKg, 0.1));
  CHECK(out.bytes.size() < lossless_size(sequence) / 2);
  CHECK(out.stats.kg > 0);
  CHECK(out.stats.notes.empty());
}

TEST_CASE("what does not extend in space is kept as it is", "[exact_targets]") {
  Sequence point = sequence_of({animate(single_vertex(), 5)});
  for (float& x : point.shots[0].positions) x = 0.1f;
  for (const EncodeOptions& options : {aiming(Target::kKg, 0.05), aiming(Target::kMaxError, 0)})
    CHECK(same_positions(point, decode_or_fail(encode_or_fail(point, options).bytes)));
}

TEST_CASE("units as small and as large as binary32 has them are no matter", "[exact_targets]") {
  for (const int exponent : {-140, -120, 100}) {
    Sequence sequence = bending(6);
    for (float& x : sequence.shots[0].positions) x = std::ldexp(x, exponent);
    for (const Profile profile : {Profile::kMain, Profile::kFast, Profile::kThesis}) {
      EncodeOptions options = aiming(Target::kKg, 0.5);
      options.profile = profile;
      CHECK(errors_of(sequence, encode_or_fail(sequence, options)).kg <= 0.5);
    }
  }
}
