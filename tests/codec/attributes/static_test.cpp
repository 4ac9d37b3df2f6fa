#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "tests/codec/attributes/samples.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// The elements of every face, so that faces may be compared whatever their order: for each, its
/// vertices with what the corners have, from the lowest vertex on.
std::multimap<std::vector<uint32_t>, std::vector<uint8_t>> by_face(const Shot& shot,
                                                                   const Attribute& a) {
  std::multimap<std::vector<uint32_t>, std::vector<uint8_t>> out;
  const Connectivity& c = shot.connectivity;
  const size_t bytes = a.element_bytes();
  size_t first = 0;
  for (size_t f = 0; f < c.face_sizes.size(); ++f) {
    const size_t size = c.face_sizes[f];
    const auto corners = std::span(c.corners).subspan(first, size);
    const auto start =
        static_cast<size_t>(std::min_element(corners.begin(), corners.end()) - corners.begin());
    std::vector<uint32_t> vertices;
    std::vector<uint8_t> values;
    for (size_t i = 0; i < size; ++i) {
      const size_t at = (start + i) % size;
      vertices.push_back(corners[at]);
      const size_t element = a.domain == Domain::kFace ? f : first + at;
      const auto from = a.values.begin() + static_cast<ptrdiff_t>(element * bytes);
      values.insert(values.end(), from, from + static_cast<ptrdiff_t>(bytes));
    }
    out.emplace(std::move(vertices), std::move(values));
    first += size;
  }
  return out;
}

void check_same(const Shot& a, const Attribute& x, const Shot& b, const Attribute& y) {
  CHECK(x.name == y.name);
  CHECK(x.semantic == y.semantic);
  CHECK(x.domain == y.domain);
  CHECK(x.type == y.type);
  CHECK(x.channel_count == y.channel_count);
  CHECK(x.names == y.names);
  if (x.domain == Domain::kVertex || x.domain == Domain::kShot) {
    CHECK(x.values == y.values);
  } else {
    CHECK(by_face(a, x) == by_face(b, y));
  }
}

}  // namespace

TEST_CASE("static attributes of every domain and type come back exactly", "[attributes]") {
  std::mt19937 random(7);
  for (Shape& shape : small_shapes()) {
    INFO(shape.name);
    Sequence sequence = sequence_of({animate(shape, 2)});
    add_all(sequence.shots[0], random);
    sequence.resources.push_back({"scene.mtl", "model/mtl", {1, 2, 3, 0, 255}});
    for (const bool lossless : {false, true}) {
      EncodeOptions options = quick_options();
      if (lossless) options.target = Target::kLossless;
      const Sequence decoded = decode_or_fail(encode_or_fail(sequence, options).bytes);
      const Shot &a = sequence.shots[0], &b = decoded.shots[0];
      REQUIRE(b.attributes.size() == a.attributes.size());
      for (size_t i = 0; i < a.attributes.size(); ++i) {
        INFO(a.attributes[i].name);
        check_same(a, a.attributes[i], b, b.attributes[i]);
      }
      CHECK(decoded.resources == sequence.resources);
    }
  }
}

TEST_CASE("bits that are no decimals survive: signed zeros, infinities, NaN, subnormals",
          "[attributes]") {
  Sequence sequence = sequence_of({animate(grid(20, 20), 1)});
  Shot& shot = sequence.shots[0];
  for (const double step : {1e-3, 0.0123456789e-3}) {
    std::vector<float> values;
    for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v)
      values.push_back(static_cast<float>(v * step));
    values[5] = -0.0f;
    values[17] = std::numeric_limits<float>::infinity();
    values[99] = std::bit_cast<float>(0x7FC12345u);
    values[100] = std::bit_cast<float>(0xFFC00001u);
    values[101] = std::numeric_limits<float>::denorm_min();
    values[102] = -std::numeric_limits<float>::max();
    shot.attributes.push_back(make("odd", Domain::kVertex, ValueType::kBinary32, 1, values));
  }
  const Sequence decoded = decode_or_fail(encode_or_fail(sequence, quick_options()).bytes);
  CHECK(decoded.shots[0].attributes[0].values == shot.attributes[0].values);
  CHECK(decoded.shots[0].attributes[1].values == shot.attributes[1].values);
}

TEST_CASE("no value is further off than its channel allows", "[attributes]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-5, 5);
  Sequence sequence = sequence_of({animate(torus(20, 10), 1)});
  Shot& shot = sequence.shots[0];
  std::vector<float> values(2 * shot.element_count(Domain::kCorner));
  for (float& x : values) x = uniform(random);
  shot.attributes.push_back(make("w", Domain::kCorner, ValueType::kBinary32, 2, values));
  shot.attributes[0].max_error = {0.01, 1.5};
  std::vector<uint8_t> colours(4 * shot.element_count(Domain::kVertex));
  for (uint8_t& x : colours) x = static_cast<uint8_t>(random());
  shot.attributes.push_back(make("c", Domain::kVertex, ValueType::kU8Normalised, 4, colours));
  shot.attributes[1].max_error = {0.0101, 0.0101, 0.0101, 0.001};

  EncodeOptions options = quick_options();
  options.target = Target::kLossless;  // faces in order
  const Encoded encoded = encode_or_fail(sequence, options);
  const Shot decoded = decode_or_fail(encoded.bytes).shots[0];
  REQUIRE(decoded.connectivity == shot.connectivity);
  double largest[2] = {0, 0};
  for (size_t i = 0; i < values.size(); ++i) {
    const auto d =
        static_cast<double>(decoded.attributes[0].get<float>(i)) - static_cast<double>(values[i]);
    largest[i % 2] = std::max(largest[i % 2], std::abs(d));
  }
  CHECK(largest[0] <= 0.01);
  CHECK(largest[0] > 0.005);  // or bits are wasted
  CHECK(largest[1] <= 1.5);
  CHECK(largest[1] > 0.75);
  for (size_t i = 0; i < colours.size(); ++i) {
    const int d = std::abs(decoded.attributes[1].get<uint8_t>(i) - colours[i]);
    CHECK(d <= (i % 4 == 3 ? 0 : 2));  // floor(0.0101 * 255)
  }
}

TEST_CASE("values that neighbours tell cost little", "[attributes]") {
  // What a plane maps to: after the first few, every value is where its neighbours say.
  Shape shape = grid(40, 40);
  Sequence sequence = sequence_of({animate(shape, 1)});
  const size_t bare = encode_or_fail(sequence, quick_options()).bytes.size();
  Shot& shot = sequence.shots[0];
  std::vector<float> values;
  for (const uint32_t v : shot.connectivity.corners) {
    values.push_back(static_cast<float>(v % 40) / 40);
    values.push_back(static_cast<float>(v / 40) / 40);
  }
  Attribute uv = make("vt", Domain::kCorner, ValueType::kBinary32, 2, values);
  uv.semantic = Semantic::kTextureCoordinate;
  uv.max_error = {1.0 / 8192, 1.0 / 8192};
  shot.attributes = {uv};
  const size_t with_uv = encode_or_fail(sequence, quick_options()).bytes.size();
  CHECK(with_uv - bare < 1600 * 2 / 8 * 2);  // 2 bits a coordinate

  std::vector<uint16_t> one(shot.element_count(Domain::kFace), 1);
  for (size_t f = one.size() / 2; f < one.size(); ++f) one[f] = 2;
  Attribute material = make("usemtl", Domain::kFace, ValueType::kU16, 1, one);
  material.semantic = Semantic::kMaterial;
  shot.attributes = {material};
  EncodeOptions lossless;
  lossless.target = Target::kLossless;
  const size_t with_material = encode_or_fail(sequence, lossless).bytes.size();
  shot.attributes.clear();
  CHECK(with_material - encode_or_fail(sequence, lossless).bytes.size() < 60);
}

TEST_CASE("an attribute that is not as it should be is refused by name", "[attributes]") {
  Sequence sequence = sequence_of({animate(tetrahedron(), 1)});
  std::vector<uint8_t> bytes;
  EncodeStats stats;
  const auto refused = [&](const Attribute& a, const std::string& word) {
    sequence.shots[0].attributes = {a};
    const Status s = encode(sequence, quick_options(), bytes, stats);
    CHECK(s.code() == StatusCode::kInvalidArgument);
    CHECK(s.message().find(word) != std::string::npos);
    CHECK(bytes.empty());
  };
  const Attribute good = make("p", Domain::kVertex, ValueType::kU8, 1, std::vector<uint8_t>(4));
  Attribute bad = good;
  bad.values.pop_back();
  refused(bad, "\"p\"");
  bad = good;
  bad.channel_count = 17;
  refused(bad, "16 channels");
  bad = good;
  bad.max_error = {-1};
  refused(bad, "error");
  bad = good;
  bad.max_error = {1, 1};
  refused(bad, "every channel");
  bad = good;
  bad.name = std::string(257, 'x');
  refused(bad, "256 bytes");
}

TEST_CASE("places in a list cost little where they follow the faces", "[attributes]") {
  // As writers of OBJ number texture coordinates: anew where a corner first has one.
  Shot shot = animate(grid(30, 20), 1);
  const auto& corners = shot.connectivity.corners;
  std::vector<int32_t> place(shot.connectivity.vertex_count, -1), places;
  int32_t next = 0;
  for (const uint32_t v : corners) {
    if (place[v] < 0) place[v] = next++;
    places.push_back(place[v]);
  }
  EncodeOptions options = quick_options();
  options.target = Target::kLossless;  // keeps the order of faces
  const size_t bare = encode_or_fail(sequence_of({shot}), options).bytes.size();
  const auto cost = [&](const std::vector<int32_t>& values) {
    Attribute a = make("vt", Domain::kCorner, ValueType::kI32, 1, values);
    a.semantic = Semantic::kIndex;
    shot.attributes = {a};
    const Bytes bytes = encode_or_fail(sequence_of({shot}), options).bytes;
    CHECK(decode_or_fail(bytes).shots[0].attributes[0].values == a.values);
    return bytes.size() - bare;
  };
  INFO(cost(places));
  CHECK(cost(places) < 60 + corners.size() / 80);  // a tenth of a bit
  std::vector<int32_t> order(place.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(3);
  std::shuffle(order.begin(), order.end(), random);
  for (int32_t& p : places) p = order[static_cast<size_t>(p)];
  CHECK(cost(places) > order.size());  // a shuffled list is no less than its order
}

TEST_CASE("attributes follow what they belong to where the order is dropped", "[attributes]") {
  // Each value tells which vertex, or vertices, it belongs to by their positions.
  const auto mark = [](const Shot& shot, uint32_t t, uint32_t v) {
    int32_t out = 0;
    for (size_t a = 0; a < 3; ++a)
      out = (out * 31 + static_cast<int32_t>(1e4f * shot.frame(t)[3 * v + a])) % 1000003;
    return out;
  };
  const auto marks = [&](const Shot& shot) {
    std::vector<int32_t> vertices, moving, corners, faces;
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v)
        moving.push_back(mark(shot, t, v));
    }
    for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v)
      vertices.push_back(mark(shot, 0, v));
    for (size_t c = 0; c < shot.connectivity.corners.size(); ++c) {
      corners.push_back(mark(shot, 0, shot.connectivity.corners[c]));
      if (c % 3 == 0) faces.push_back(0);
      faces.back() += corners.back();
    }
    std::vector<Attribute> out = {
        make("vertices", Domain::kVertex, ValueType::kI32, 1, vertices),
        make("corners", Domain::kCorner, ValueType::kI32, 1, corners),
        make("faces", Domain::kFace, ValueType::kI32, 1, faces),
        make("moving", Domain::kVertex, ValueType::kI32, 1, moving),
    };
    out.back().animated = true;
    return out;
  };
  Shape shape = torus(9, 7);
  shape.add_vertex(5, 5, 5);  // without a face
  Shot shot = animate(shape, 3);
  shot.attributes = marks(shot);
  EncodeOptions options = quick_options();
  options.target = Target::kLossless;
  options.reorder = true;
  const Shot decoded = decode_or_fail(encode_or_fail(sequence_of({shot}), options).bytes).shots[0];
  CHECK(decoded.positions != shot.positions);
  const std::vector<Attribute> expected = marks(decoded);
  REQUIRE(decoded.attributes.size() == expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    INFO(expected[i].name);
    CHECK(decoded.attributes[i].values == expected[i].values);
  }
}
