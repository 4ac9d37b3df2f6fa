#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/codec/attributes/samples.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// A wave over the elements, [frame][element][channel].
std::vector<float> wave(size_t elements, uint32_t frames, uint32_t channels) {
  std::vector<float> out;
  for (uint32_t t = 0; t < frames; ++t) {
    for (size_t e = 0; e < elements; ++e) {
      for (uint32_t k = 0; k < channels; ++k)
        out.push_back(
            static_cast<float>(10 * k + std::sin(0.3 * t + 0.05 * static_cast<double>(e) + k)));
    }
  }
  return out;
}

Attribute moving(const std::string& name, const Shot& shot, Domain domain, uint32_t channels) {
  Attribute a = make(name, domain, ValueType::kBinary32, channels,
                     wave(shot.element_count(domain), shot.frame_count, channels));
  a.animated = true;
  return a;
}

EncodeOptions lossless() {
  EncodeOptions out;
  out.target = Target::kLossless;
  return out;
}

}  // namespace

TEST_CASE("animated attributes come back exactly", "[attributes]") {
  Shot shot = animate(mixed_polygons(), 7);
  for (const Domain domain : {Domain::kVertex, Domain::kCorner, Domain::kFace, Domain::kShot}) {
    shot.attributes.push_back(moving("a", shot, domain, 1));
    shot.attributes.push_back(moving("b", shot, domain, 4));
  }
  Attribute colours = make("c", Domain::kVertex, ValueType::kU8Normalised, 4,
                           std::vector<uint8_t>(7 * 4 * shot.connectivity.vertex_count));
  colours.animated = true;
  for (size_t i = 0; i < colours.values.size(); ++i)
    colours.values[i] = static_cast<uint8_t>(i * i);
  shot.attributes.push_back(colours);
  shot.attributes[0].values[3] = 0x80;  // -0
  const Sequence sequence = sequence_of({shot});
  EncodeOptions options = lossless();
  options.group_length = 3;
  const Bytes bytes = encode_or_fail(sequence, options).bytes;
  const Shot decoded = decode_or_fail(bytes).shots[0];
  REQUIRE(decoded.connectivity == shot.connectivity);
  REQUIRE(decoded.attributes.size() == shot.attributes.size());
  for (size_t i = 0; i < shot.attributes.size(); ++i) {
    INFO(i);
    CHECK(decoded.attributes[i].values == shot.attributes[i].values);
  }
  // One frame at a time, backwards.
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  for (uint32_t t = 7; t-- > 0;) {
    for (uint32_t i = 0; i < shot.attributes.size(); ++i) {
      Attribute one;
      REQUIRE(decoder->decode_attribute(t, i, one).ok());
      const auto& all = shot.attributes[i].values;
      const size_t size = all.size() / 7;
      CHECK(std::equal(one.values.begin(), one.values.end(),
                       all.begin() + static_cast<ptrdiff_t>(t * size),
                       all.begin() + static_cast<ptrdiff_t>((t + 1) * size)));
    }
  }
}

TEST_CASE("animated values stay within their errors, in every profile", "[attributes]") {
  std::mt19937 random(1);
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    Shot shot = animate(grid(12, 9), 20);
    shot.attributes.push_back(moving("smooth", shot, Domain::kVertex, 2));
    shot.attributes[0].max_error = {1e-3, 0.02};
    shot.attributes.push_back(moving("noise", shot, Domain::kFace, 1));
    std::vector<float> noise(20 * shot.element_count(Domain::kFace));
    for (float& x : noise) x = static_cast<float>(random() % 1000);
    shot.attributes[1].assign(std::span<const float>(noise));
    shot.attributes[1].max_error = {0.5};
    Attribute bytes =
        make("bytes", Domain::kVertex, ValueType::kU8, 1, std::vector<uint8_t>(20 * 108));
    bytes.animated = true;
    bytes.max_error = {3};
    for (uint8_t& x : bytes.values) x = static_cast<uint8_t>(random());
    shot.attributes.push_back(bytes);
    EncodeOptions options = quick_options();
    options.profile = profile;
    const Shot decoded =
        decode_or_fail(encode_or_fail(sequence_of({shot}), options).bytes).shots[0];
    const auto largest = [&](uint32_t index, size_t channel) {
      const Attribute& a = shot.attributes[index];
      double out = 0;
      for (size_t i = channel; i < a.values.size() / 4; i += a.channel_count)
        out = std::max(out, std::abs(static_cast<double>(a.get<float>(i)) -
                                     static_cast<double>(decoded.attributes[index].get<float>(i))));
      return out;
    };
    CHECK(largest(0, 0) <= 1e-3);
    CHECK(largest(0, 1) <= 0.02);
    CHECK(largest(0, 1) > 0.002);
    int worst = 0;
    for (size_t i = 0; i < bytes.values.size(); ++i)
      worst = std::max(worst, std::abs(bytes.values[i] - decoded.attributes[2].values[i]));
    CHECK(worst <= 3);
    CHECK(worst > 0);
  }
}

TEST_CASE("what cannot be kept of moving values is said", "[attributes]") {
  Shot shot = animate(tetrahedron(), 2);
  Attribute a = moving("p", shot, Domain::kVertex, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(a.values.data(), &nan, 4);
  shot.attributes = {a};
  std::vector<uint8_t> bytes;
  EncodeStats stats;
  const Status s = encode(sequence_of({shot}), quick_options(), bytes, stats);
  CHECK(s.code() == StatusCode::kInvalidArgument);
  CHECK(s.message().find("\"p\"") != std::string::npos);
}
