#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/codec/attributes/samples.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& u, const Vector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Vector normalised(Vector n) {
  const double length = std::hypot(n[0], n[1], n[2]);
  for (double& x : n) x /= length;
  return n;
}

/// Normal of the triangle of three corners in a row, twice its area long.
Vector area_normal(const Shot& shot, size_t first, uint32_t t) {
  Vector u, v;
  for (size_t a = 0; a < 3; ++a) {
    const auto at = [&](size_t i) {
      return static_cast<double>(shot.frame(t)[3 * shot.connectivity.corners[first + i] + a]);
    };
    u[a] = at(1) - at(0);
    v[a] = at(2) - at(0);
  }
  return cross(u, v);
}

/// Unit normal of a flat face, from its first three corners.
Vector face_normal(const Shot& shot, size_t face, uint32_t t) {
  size_t first = 0;
  for (size_t f = 0; f < face; ++f) first += shot.connectivity.face_sizes[f];
  return normalised(area_normal(shot, first, t));
}

/// Unit normals of the vertices of triangles, which count by their areas.
std::vector<Vector> smooth_normals(const Shot& shot, uint32_t t) {
  std::vector<Vector> out(shot.connectivity.vertex_count, Vector{});
  for (size_t c = 0; c < shot.connectivity.corners.size(); c += 3) {
    const Vector n = area_normal(shot, c, t);
    for (size_t i = 0; i < 3; ++i) {
      for (size_t a = 0; a < 3; ++a) out[shot.connectivity.corners[c + i]][a] += n[a];
    }
  }
  for (Vector& n : out) n = normalised(n);
  return out;
}

/// A normal at every corner: that of its face.
Attribute flat_normals(const Shot& shot) {
  std::vector<float> values;
  for (size_t f = 0; f < shot.connectivity.face_sizes.size(); ++f) {
    const Vector n = face_normal(shot, f, 0);
    for (uint32_t i = 0; i < shot.connectivity.face_sizes[f]; ++i) {
      for (const double x : n) values.push_back(static_cast<float>(x));
    }
  }
  Attribute out = make("vn", Domain::kCorner, ValueType::kBinary32, 3, values);
  out.semantic = Semantic::kNormal;
  out.max_angle = 2;
  return out;
}

Vector vector_of(const Attribute& a, size_t element) {
  Vector out;
  for (size_t i = 0; i < 3; ++i) out[i] = double{a.get<float>(3 * element + i)};
  return out;
}

/// Degrees between a normal and what it should be, of any length.
double angle(const Attribute& a, size_t element, const Vector& wanted) {
  const Vector n = vector_of(a, element);
  const Vector across{n[1] * wanted[2] - n[2] * wanted[1], n[2] * wanted[0] - n[0] * wanted[2],
                      n[0] * wanted[1] - n[1] * wanted[0]};
  const double along = n[0] * wanted[0] + n[1] * wanted[1] + n[2] * wanted[2];
  return std::atan2(std::hypot(across[0], across[1], across[2]), along) * 180 / 3.14159265358979;
}

}  // namespace

TEST_CASE("hard edges stay hard in every frame, and cost seams alone", "[attributes]") {
  Shape shape = torus(16, 10);
  for (size_t i = 0; i < shape.positions.size(); ++i)  // no two triangles in one plane
    shape.positions[i] *= 1 + 0.05f * static_cast<float>(std::sin(static_cast<double>(i * i)));
  Shot shot = animate(shape, 6);
  EncodeOptions options;
  options.target = Target::kLossless;
  const size_t bare = encode_or_fail(sequence_of({shot}), options).bytes.size();
  shot.attributes = {flat_normals(shot)};
  shot.attributes[0].max_angle = 1e-4;  // every edge is a seam
  const Bytes bytes = encode_or_fail(sequence_of({shot}), options).bytes;
  const Shot decoded = decode_or_fail(bytes).shots[0];
  REQUIRE(decoded.attributes.size() == 1);
  const Attribute& normals = decoded.attributes[0];
  CHECK(normals.animated);
  CHECK(normals.semantic == Semantic::kNormal);
  REQUIRE(normals.values.size() == 6 * shot.attributes[0].values.size());
  const size_t corners = shot.connectivity.corners.size();
  double worst = 0;
  for (uint32_t t = 0; t < 6; ++t) {
    for (size_t f = 0; f < shot.connectivity.face_sizes.size(); ++f) {
      const Vector n = face_normal(decoded, f, t);
      for (size_t i = 0; i < 9; ++i) {
        const auto x = normals.get<float>((t * corners + 3 * f) * 3 + i);
        worst = std::max(worst, std::abs(static_cast<double>(x) - n[i % 3]));
      }
    }
  }
  CHECK(worst < 1e-6);
  constexpr double kHeader = 24;  // bytes
  CHECK(static_cast<double>(bytes.size() - bare) <=
        kHeader + 0.2 * static_cast<double>(corners) / 8);

  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  Attribute one;
  REQUIRE(decoder->decode_attribute(4, 0, one).ok());
  CHECK(std::equal(one.values.begin(), one.values.end(),
                   normals.values.begin() + static_cast<ptrdiff_t>(4 * corners * 12)));
}

TEST_CASE("normals that differ from computed ones are coded", "[attributes]") {
  Shot shot = animate(torus(8, 6), 2);
  Attribute turned = flat_normals(shot);
  for (size_t i = 0; i + 12 <= turned.values.size(); i += 12)
    std::swap_ranges(turned.values.begin() + static_cast<ptrdiff_t>(i),
                     turned.values.begin() + static_cast<ptrdiff_t>(i + 4),
                     turned.values.begin() + static_cast<ptrdiff_t>(i + 4));
  turned.corrected_angle = 0;
  shot.attributes = {turned};
  EncodeOptions options;
  options.target = Target::kLossless;
  const Shot decoded = decode_or_fail(encode_or_fail(sequence_of({shot}), options).bytes).shots[0];
  CHECK(!decoded.attributes[0].animated);
  CHECK(decoded.attributes[0].values == turned.values);
}

TEST_CASE("normals that are turned move with the surface", "[attributes]") {
  // A torus that turns around z: what is right in its first frame is right when turned as it is.
  const Motion turn = [](const float* rest, double time, double* xyz) {
    const double c = std::cos(2 * time), s = std::sin(2 * time);
    const double x = double{rest[0]}, y = double{rest[1]};
    xyz[0] = c * x - s * y;
    xyz[1] = s * x + c * y;
    xyz[2] = double{rest[2]};
  };
  Shot shot = animate(torus(10, 8), 4, turn);
  Attribute wanted = flat_normals(shot);
  std::vector<float> tilted;
  const size_t count = shot.connectivity.corners.size();
  for (size_t i = 0; i < count; ++i) {  // every second vertex towards (1, 2, 3), far over
    const float far = shot.connectivity.corners[i] % 2 == 0 ? 0.0f : 0.4f;
    for (size_t a = 0; a < 3; ++a)
      tilted.push_back(wanted.get<float>(3 * i + a) + far * static_cast<float>(a + 1));
  }
  wanted.assign(std::span<const float>(tilted));
  wanted.max_angle = 2;
  wanted.corrected_angle = 0.25;
  shot.attributes = {wanted};
  EncodeOptions options;
  options.target = Target::kLossless;
  const Shot decoded = decode_or_fail(encode_or_fail(sequence_of({shot}), options).bytes).shots[0];
  REQUIRE(decoded.attributes[0].animated);
  REQUIRE(decoded.attributes[0].values.size() == 4 * count * 12);
  for (uint32_t t = 0; t < 4; ++t) {
    double worst[2] = {0, 0};
    for (size_t i = 0; i < count; ++i) {
      const double c = std::cos(2 * t / 4.0), s = std::sin(2 * t / 4.0);
      const double x = double{tilted[3 * i]}, y = double{tilted[3 * i + 1]};
      const Vector w{c * x - s * y, s * x + c * y, double{tilted[3 * i + 2]}};
      double& worst_so_far = worst[shot.connectivity.corners[i] % 2];
      worst_so_far = std::max(worst_so_far, angle(decoded.attributes[0], t * count + i, w));
    }
    CHECK(worst[0] < 1e-3);
    CHECK(worst[1] < 0.26);
    CHECK(worst[1] > 0.02);  // quantized
  }
}

TEST_CASE("normals that turn by themselves are within their angle", "[attributes]") {
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    Shot shot = animate(torus(8, 6), 5);
    add_turned_normals(shot);
    EncodeOptions options = quick_options();
    options.group_length = 2;
    options.profile = profile;
    const Bytes bytes = encode_or_fail(sequence_of({shot}), options).bytes;
    std::unique_ptr<Decoder> decoder;
    REQUIRE(Decoder::open(bytes, {}, decoder).ok());
    CHECK(decoder->info().attributes[0].header.flags == 7);
    CHECK(decoder->info().attributes[1].header.flags == 15);
    const Shot decoded = decode_or_fail(bytes).shots[0];
    const Attribute &still = decoded.attributes[0], &turning = decoded.attributes[1];
    const size_t corners = shot.connectivity.corners.size();
    double worst = 0;
    for (size_t v = 0; v < 48; ++v)
      worst = std::max(worst, angle(still, v, vector_of(shot.attributes[0], v)));
    for (size_t i = 0; i < 5 * corners; ++i) {  // faces come in another order
      const uint32_t v = decoded.connectivity.corners[i % corners];
      const auto& in = shot.connectivity.corners;
      const auto at = static_cast<size_t>(std::find(in.begin(), in.end(), v) - in.begin());
      const Vector wanted = vector_of(shot.attributes[1], i / corners * corners + at);
      worst = std::max(worst, angle(turning, i, wanted));
    }
    CHECK(worst < 1.001);
    CHECK(worst > 0.1);
    for (const uint32_t t : {4u, 1u}) {
      Attribute one;
      REQUIRE(decoder->decode_attribute(t, 1, one).ok());
      CHECK(std::equal(one.values.begin(), one.values.end(),
                       turning.values.begin() + static_cast<ptrdiff_t>(t * corners * 12)));
    }
  }
}

TEST_CASE("what is computed beside normals that turn is within its angle, too", "[attributes]") {
  Shot shot = animate(torus(16, 12), 5);
  const size_t count = shot.connectivity.vertex_count;
  std::vector<float> values;
  for (uint32_t t = 0; t < 5; ++t) {
    const std::vector<Vector> smooth = smooth_normals(shot, t);
    for (size_t v = 0; v < count; ++v) {  // up to 3 degrees off, each frame in another direction
      const Vector& n = smooth[v];
      const double far = std::tan(3.0 * static_cast<double>(v) / static_cast<double>(count) / 57.3);
      const Vector other = std::abs(n[2]) < 0.9 ? Vector{0, 0, 1} : Vector{1, 0, 0};
      const Vector p = normalised(cross(n, other)), q = cross(n, p);
      const double turn = 2.0 * t + static_cast<double>(v);
      for (size_t a = 0; a < 3; ++a)
        values.push_back(
            static_cast<float>(n[a] + far * (std::cos(turn) * p[a] + std::sin(turn) * q[a])));
    }
  }
  Attribute wanted = make("vn", Domain::kVertex, ValueType::kBinary32, 3, values);
  wanted.semantic = Semantic::kNormal;
  wanted.animated = true;
  wanted.max_angle = 2;
  wanted.corrected_angle = 0.5;
  shot.attributes = {wanted};
  EncodeOptions options;
  options.target = Target::kLossless;
  const Shot decoded = decode_or_fail(encode_or_fail(sequence_of({shot}), options).bytes).shots[0];
  double worst = 0;
  for (size_t i = 0; i < 5 * count; ++i)
    worst = std::max(worst, angle(decoded.attributes[0], i, vector_of(wanted, i)));
  CHECK(worst <= 2.0001);
  CHECK(worst > 1.2);  // of those that are not coded
}

TEST_CASE("bounds of groups hold all positions and no more", "[attributes]") {
  const Sequence sequence = sequence_of({animate(torus(8, 6), 7), animate(grid(4, 4), 2)});
  EncodeOptions options = quick_options();
  options.group_length = 3;
  options.bounds = true;
  const Bytes bytes = encode_or_fail(sequence, options).bytes;
  const Sequence decoded = decode_or_fail(bytes);
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(bytes, {}, decoder).ok());
  const StreamInfo& info = decoder->info();
  REQUIRE(info.bounds.size() == 4);
  for (size_t g = 0; g < info.groups.size(); ++g) {
    const Shot& shot = decoded.shots[info.groups[g].shot];
    const uint32_t first = info.groups[g].first_frame - info.shots[info.groups[g].shot].first_frame;
    for (size_t axis = 0; axis < 3; ++axis) {
      float low = INFINITY, high = -INFINITY;
      for (uint32_t t = first; t < first + info.groups[g].frame_count; ++t) {
        for (size_t i = axis; i < shot.frame(t).size(); i += 3) {
          low = std::min(low, shot.frame(t)[i]);
          high = std::max(high, shot.frame(t)[i]);
        }
      }
      CHECK(info.bounds[g].low[axis] == low);
      CHECK(info.bounds[g].high[axis] == high);
    }
  }
}
