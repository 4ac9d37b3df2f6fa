#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Encodes, decodes, and checks all that must hold for any sequence and options.
Encoded check_round_trip(const Sequence& sequence, const EncodeOptions& options) {
  Encoded out = encode_or_fail(sequence, options);
  const Sequence decoded = decode_or_fail(out.bytes);
  REQUIRE(decoded.shots.size() == sequence.shots.size());
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    const Shot &a = sequence.shots[i], &b = decoded.shots[i];
    CHECK(b.frame_count == a.frame_count);
    CHECK(b.connectivity.vertex_count == a.connectivity.vertex_count);
    if (!options.reorder) CHECK(face_set(b.connectivity) == face_set(a.connectivity));
  }
  if (!options.reorder) {
    const Errors errors = measure(sequence, decoded);
    CHECK(out.stats.kg == Approx(errors.kg).margin(1e-9));
    CHECK(out.stats.rmse == Approx(errors.rmse).margin(1e-12));
    CHECK(out.stats.max_error == Approx(errors.largest).margin(1e-12));
    if (options.target == Target::kKg) CHECK(errors.kg <= options.target_value);
    if (options.target == Target::kMaxError) CHECK(errors.largest <= options.target_value);
  }
  CHECK(out.stats.bytes == out.bytes.size());
  CHECK(out.stats.bpvf ==
        Approx(8.0 * static_cast<double>(out.bytes.size()) / vertex_frames(sequence)));
  double bits = 0;
  for (const auto& section : out.stats.sections) bits += section.bits;
  CHECK(bits == 8.0 * static_cast<double>(out.bytes.size()));
  return out;
}

std::unique_ptr<Decoder> open(const Bytes& bytes) {
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  return decoder;
}

}  // namespace

TEST_CASE("sequences of every topology survive", "[codec]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    for (const Profile profile : {Profile::kMain, Profile::kFast, Profile::kThesis}) {
      EncodeOptions options = quick_options();
      options.profile = profile;
      check_round_trip(sequence_of({animate(shape, 9)}), options);
    }
  }
}

TEST_CASE("a single frame survives", "[codec]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    check_round_trip(sequence_of({animate(shape, 1)}), quick_options());
  }
}

TEST_CASE("a mesh that does not move costs next to nothing a frame", "[codec]") {
  const Encoded one =
      check_round_trip(sequence_of({animate(torus(16, 11), 1, rest)}), quick_options());
  const Encoded many =
      check_round_trip(sequence_of({animate(torus(16, 11), 60, rest)}), quick_options());
  CHECK(many.bytes.size() < one.bytes.size() + 60 * 20);
}

TEST_CASE("a mesh that shrinks to a point survives", "[codec]") {
  const auto shrink = [](const float* p, double time, double* xyz) {
    for (int a = 0; a < 3; ++a)
      xyz[a] = time < 0.5 ? static_cast<double>(p[a]) * (1 - 2 * time) : 0;
  };
  check_round_trip(sequence_of({animate(torus(16, 11), 12, shrink)}), quick_options());
  const auto grow = [&](const float* p, double time, double* xyz) { shrink(p, 1 - time, xyz); };
  check_round_trip(sequence_of({animate(torus(16, 11), 12, grow)}), quick_options());
}

TEST_CASE("a frame far away survives", "[codec]") {
  for (const double offset : {1e6, 1e12}) {
    const auto jump = [offset](const float* p, double time, double* xyz) {
      bend(p, time, xyz);
      if (time > 0.45 && time < 0.55) xyz[0] += offset;
    };
    // A binary32 at 1e6 has steps of 1/16, at 1e12 of 65536.
    EncodeOptions options = quick_options();
    options.target = Target::kMaxError;
    options.target_value = offset * 1e-7;
    const Sequence sequence = sequence_of({animate(torus(16, 11), 10, jump)});
    check_round_trip(sequence, options);
  }
}

TEST_CASE("a vertex far away survives", "[codec]") {
  for (const double offset : {1e3, 1e6}) {
    const auto jump = [offset](const float* p, double time, double* xyz) {
      bend(p, time, xyz);
      if (p[0] > 3.99f && time > 0.45 && time < 0.55) xyz[1] += offset;
    };
    const Sequence sequence = sequence_of({animate(torus(16, 11), 10, jump)});
    EncodeOptions options = quick_options();
    options.target = Target::kMaxError;
    options.target_value = std::max(1e-3, offset * 1e-6);
    check_round_trip(sequence, options);
  }
}

TEST_CASE("meshes of any scale survive", "[codec]") {
  for (const double scale : {1e-30, 1e-6, 1e9, 1e30}) {
    INFO(scale);
    const auto scaled = [scale](const float* p, double time, double* xyz) {
      bend(p, time, xyz);
      for (int a = 0; a < 3; ++a) xyz[a] *= scale;
    };
    check_round_trip(sequence_of({animate(torus(16, 11), 8, scaled)}), quick_options());
  }
}

TEST_CASE("connectivity may change within a sequence", "[codec]") {
  const Sequence sequence = sequence_of(
      {animate(torus(16, 11), 7), animate(mixed_polygons(), 1), animate(grid(9, 8), 5)});
  const Encoded out = check_round_trip(sequence, quick_options());
  const auto decoder = open(out.bytes);
  const StreamInfo& info = decoder->info();
  CHECK(info.frame_count == 13);
  REQUIRE(info.shots.size() == 3);
  CHECK(info.shots[1].first_frame == 7);
  CHECK(info.shots[1].frame_count == 1);
  CHECK(info.shots[2].vertex_count == 72);
  CHECK(info.shots[2].face_count == 56);
  const Connectivity* connectivity = nullptr;
  REQUIRE(decoder->connectivity(7, connectivity).ok());
  CHECK(face_set(*connectivity) == face_set(sequence.shots[1].connectivity));
}

TEST_CASE("frame rate, start and metadata survive", "[codec]") {
  Sequence sequence = sequence_of({animate(tetrahedron(), 3)});
  sequence.frame_rate = 23.976;
  sequence.start_time = -12.5;
  sequence.metadata = {{"name", "walk"}, {"unit", "cm"}, {"empty", ""}, {"Ωmega", "日本"}};
  const Encoded out = check_round_trip(sequence, quick_options());
  const Sequence decoded = decode_or_fail(out.bytes);
  CHECK(decoded.frame_rate == 23.976);
  CHECK(decoded.start_time == -12.5);
  CHECK(decoded.metadata == sequence.metadata);
}

TEST_CASE("a dropped vertex order is a permutation of vertices and faces", "[codec]") {
  const Shot shot = animate(torus(16, 11), 6);
  EncodeOptions options = quick_options();
  const Encoded kept = check_round_trip(sequence_of({shot}), options);
  options.reorder = true;
  const Encoded dropped = check_round_trip(sequence_of({shot}), options);
  CHECK(dropped.bytes.size() <= kept.bytes.size());
  CHECK(open(kept.bytes)->info().shots[0].order_kept);
  CHECK_FALSE(open(dropped.bytes)->info().shots[0].order_kept);

  const Shot decoded = decode_or_fail(dropped.bytes).shots[0];
  const auto distance = [&](uint32_t v, uint32_t u) {
    double sum = 0;
    for (uint32_t t = 0; t < 6; ++t) {
      for (size_t a = 0; a < 3; ++a)
        sum += std::pow(static_cast<double>(shot.frame(t)[v * 3 + a] - decoded.frame(t)[u * 3 + a]),
                        2);
    }
    return sum;
  };
  std::vector<uint32_t> image(176, 0), hits(176, 0);
  for (uint32_t u = 0; u < 176; ++u) {
    for (uint32_t v = 1; v < 176; ++v) {
      if (distance(v, u) < distance(image[u], u)) image[u] = v;
    }
    CHECK(distance(image[u], u) < 6 * 0.05 * 0.05);
    ++hits[image[u]];
  }
  CHECK(std::all_of(hits.begin(), hits.end(), [](uint32_t n) { return n == 1; }));
  Connectivity mapped = decoded.connectivity;
  for (uint32_t& c : mapped.corners) c = image[c];
  CHECK(face_set(mapped) == face_set(shot.connectivity));
}

TEST_CASE("groups decode alone and in any order", "[codec]") {
  Sequence sequence = sequence_of({animate(torus(16, 11), 23), animate(grid(9, 8), 9)});
  EncodeOptions options = quick_options();
  options.group_length = 5;
  const Encoded out = check_round_trip(sequence, options);
  const Sequence whole = decode_or_fail(out.bytes);
  const auto decoder = open(out.bytes);
  REQUIRE(decoder->info().groups.size() == 5 + 2);
  uint32_t next = 0;
  for (const StreamInfo::Group& g : decoder->info().groups) {
    CHECK(g.first_frame == next);
    CHECK(g.frame_count <= 5);
    next += g.frame_count;
  }
  CHECK(next == 32);

  const auto matches = [&](Decoder& d, uint32_t frame) {
    const Shot& shot = whole.shots[frame < 23 ? 0 : 1];
    const auto expected = shot.frame(frame < 23 ? frame : frame - 23);
    std::vector<float> xyz(expected.size());
    REQUIRE(d.decode_frame(frame, xyz.data()).ok());
    return std::memcmp(xyz.data(), expected.data(), xyz.size() * sizeof(float)) == 0;
  };
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) REQUIRE(matches(*decoder, static_cast<uint32_t>(random() % 32)));
  for (const StreamInfo::Group& g : decoder->info().groups) {
    const auto fresh = open(out.bytes);
    REQUIRE(matches(*fresh, g.first_frame + g.frame_count - 1));
  }
}

TEST_CASE("a frame is written with the caller's stride and nothing beside it", "[codec]") {
  const Encoded out = encode_or_fail(sequence_of({animate(tetrahedron(), 2)}), quick_options());
  const auto decoder = open(out.bytes);
  std::vector<float> tight(12), wide(4 * 7, -5.0f);
  REQUIRE(decoder->decode_frame(1, tight.data()).ok());
  REQUIRE(decoder->decode_frame(1, wide.data(), 7).ok());
  for (size_t i = 0; i < wide.size(); ++i)
    CHECK(wide[i] == (i % 7 < 3 ? tight[i / 7 * 3 + i % 7] : -5.0f));
}

TEST_CASE("several frames at once are the same as one after another", "[codec]") {
  EncodeOptions options = quick_options();
  options.group_length = 5;
  const Encoded out = encode_or_fail(sequence_of({animate(torus(9, 7), 23)}), options);
  const auto decoder = open(out.bytes);
  constexpr size_t kStride = 3 * 63 + 4;
  std::vector<float> xyz(19 * kStride, -5.0f);
  REQUIRE(decoder->decode_frames(3, 18, xyz.data(), kStride).ok());  // of five groups
  for (uint32_t t = 0; t < 19; ++t) {
    std::vector<float> expected(kStride, -5.0f);
    if (t < 18) REQUIRE(decoder->decode_frame(3 + t, expected.data()).ok());
    CHECK(std::equal(expected.begin(), expected.end(), xyz.begin() + t * kStride));
  }
  CHECK(decoder->decode_frames(3, 0, xyz.data(), kStride).ok());
  CHECK(decoder->decode_frames(0, 1, nullptr, kStride).code() == StatusCode::kInvalidArgument);
  CHECK(decoder->decode_frames(0, 1, xyz.data(), 188).code() == StatusCode::kInvalidArgument);
  CHECK(decoder->decode_frames(22, 2, xyz.data(), kStride).code() == StatusCode::kInvalidArgument);
  CHECK(decoder->decode_frames(UINT32_MAX, 3, xyz.data(), kStride).code() ==
        StatusCode::kInvalidArgument);
}

TEST_CASE("frames that are not there are refused", "[codec]") {
  const Encoded out = encode_or_fail(sequence_of({animate(tetrahedron(), 2)}), quick_options());
  const auto decoder = open(out.bytes);
  float xyz[12];
  const Connectivity* connectivity = nullptr;
  for (const uint32_t frame : {2u, 3u, UINT32_MAX}) {
    CHECK(decoder->decode_frame(frame, xyz).code() == StatusCode::kInvalidArgument);
    CHECK(decoder->connectivity(frame, connectivity).code() == StatusCode::kInvalidArgument);
  }
}

TEST_CASE("threads change neither bytes nor positions", "[codec]") {
  const Sequence sequence = sequence_of({animate(torus(30, 20), 12)});
  EncodeOptions options = quick_options();
  options.regions = 4;
  const Encoded one = encode_or_fail(sequence, options);
  options.threads = 4;
  CHECK(encode_or_fail(sequence, options).bytes == one.bytes);
  CHECK(same_positions(decode_or_fail(one.bytes, 1), decode_or_fail(one.bytes, 4)));
  CHECK(same_positions(decode_or_fail(one.bytes, 1), decode_or_fail(one.bytes, 0)));
}

TEST_CASE("the motion model is used with the regions asked for", "[codec]") {
  const Sequence sequence = sequence_of({animate(torus(30, 20), 12)});
  for (const Profile profile : {Profile::kMain, Profile::kFast, Profile::kThesis}) {
    EncodeOptions options = quick_options();
    options.profile = profile;
    options.regions = 5;
    const Encoded out = check_round_trip(sequence, options);
    const uint32_t regions = open(out.bytes)->info().groups[0].region_count;
    CHECK(regions >= 1);
    CHECK(regions <= 5);
    options.regions = 0;
    CHECK(open(check_round_trip(sequence, options).bytes)->info().groups[0].region_count == 0);
  }
}

TEST_CASE("every small shape takes a forced motion model", "[codec]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    EncodeOptions options = quick_options();
    options.regions = 3;
    check_round_trip(sequence_of({animate(shape, 6)}), options);
  }
}

TEST_CASE("the encoder chooses regions by itself", "[codec]") {
  EncodeOptions options = quick_options();
  options.regions = -1;
  for (const Shape& shape : {torus(30, 20), two_components(), points_only(30)})
    check_round_trip(sequence_of({animate(shape, 12)}), options);
}
