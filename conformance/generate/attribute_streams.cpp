// Streams of class *core* with attributes, resources and bounds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "codec/enc/encoder.h"
#include "conformance/generate/stream.h"
#include "tests/codec/attributes/samples.h"
#include "tests/codec/shapes.h"

namespace reeb::conformance {
namespace {

using namespace reeb::test;

Stream make_stream(const std::string& name, const std::string& sentence, const Sequence& sequence,
                   Target target, Profile profile = Profile::kMain, uint32_t group_length = 0,
                   bool bounds = false) {
  EncodeOptions options;
  options.target = target;
  options.target_value = 0.5;
  options.profile = profile;
  options.group_length = group_length;
  options.bounds = bounds;
  options.threads = 1;
  options.regions = 0;
  Stream out{"core", name, sentence, {}};
  EncodeStats stats;
  if (const Status s = encode(sequence, options, out.bytes, stats); !s.ok()) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), s.message().c_str());
    std::exit(1);
  }
  return out;
}

/// Texture coordinates of two charts, one of them mirrored, on a wavy grid of 8 by 6
/// quadrilaterals.
Shot with_texture() {
  Shot shot = animate(grid(9, 7), 2);
  std::vector<float> uv;
  for (size_t i = 0; i < shot.connectivity.corners.size(); ++i) {
    const uint32_t v = shot.connectivity.corners[i];
    const bool left = i / 4 % 8 < 4;
    const uint32_t column = v % 9, row = v / 9;
    const auto x = static_cast<float>(column), y = static_cast<float>(row);
    uv.push_back(left ? 0.05f * x + 0.001f * y * y : 0.9f - 0.05f * x);
    uv.push_back(0.06f * y);
  }
  Attribute a = make("TEXCOORD_0", Domain::kCorner, ValueType::kBinary32, 2, uv);
  a.semantic = Semantic::kTextureCoordinate;
  a.max_error = {1.0 / 4096, 1.0 / 4096};
  shot.attributes.push_back(a);
  std::vector<uint16_t> material;
  for (size_t f = 0; f < shot.connectivity.face_sizes.size(); ++f)
    material.push_back(f % 8 < 4 ? 0 : f / 16 == 1 ? 2 : 1);
  Attribute m = make("usemtl", Domain::kFace, ValueType::kU16, 1, material);
  m.semantic = Semantic::kMaterial;
  m.names = {"skin", "claw", "eye"};
  shot.attributes.push_back(m);
  return shot;
}

/// A body of two halves: texture coordinates in charts that are turned over, but for some noise,
/// colours and numbers of faces that are the same on both sides.
Shot with_halves() {
  constexpr uint32_t kHalf = 6, kRows = 7, kColumns = 2 * kHalf + 1;
  Shot shot = animate(butterfly(kHalf, kRows), 2);
  std::vector<float> uv;
  std::vector<uint8_t> colours;
  const auto across = [](uint32_t v) {
    return std::abs(static_cast<int>(v % kColumns) - static_cast<int>(kHalf));
  };
  const auto along = [](uint32_t v) { return static_cast<int>(v / kColumns); };
  for (size_t c = 0; c < shot.connectivity.corners.size(); ++c) {
    const uint32_t v = shot.connectivity.corners[c];
    const bool left = c / 6 % (kColumns - 1) < kHalf;  // by the face: the middle is a seam
    const double x = across(v), y = along(v);
    const double u = 0.05 * x + 0.01 * std::sin(x * y), w = 0.1 * y + 0.02 * std::cos(3 * x + y);
    uv.push_back(static_cast<float>(left ? u : 0.9 - u + 0.0003 * (v % 3)));
    uv.push_back(static_cast<float>(w));
  }
  for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v) {
    for (int k = 0; k < 3; ++k)
      colours.push_back(static_cast<uint8_t>(37 * across(v) * (k + 1) + 101 * along(v)));
  }
  Attribute a = make("vt", Domain::kCorner, ValueType::kBinary32, 2, uv);
  a.semantic = Semantic::kTextureCoordinate;
  a.max_error = {1.0 / 4096, 1.0 / 4096};
  shot.attributes.push_back(a);
  shot.attributes.push_back(make("rgb", Domain::kVertex, ValueType::kU8, 3, colours));
  std::vector<int32_t> faces;
  for (size_t c = 0; c < shot.connectivity.corners.size(); c += 3) {
    const uint32_t* t = &shot.connectivity.corners[c];
    faces.push_back(1000 * across(t[0]) * across(t[1]) + 7 * across(t[2]) * along(t[1]));
  }
  shot.attributes.push_back(make("face", Domain::kFace, ValueType::kI32, 1, faces));
  return shot;
}

/// Moving whole numbers at vertices, which often reach both ends of low .. high.
template <class T>
void add_whole(Shot& shot, const std::string& name, ValueType type, double low, double high,
               double max_error) {
  std::vector<T> values;
  for (uint32_t t = 0; t < shot.frame_count; ++t) {
    for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v) {
      const double wave = std::sin(0.9 * t + 0.4 * v) * 0.7 + 0.5;
      values.push_back(static_cast<T>(low + (high - low) * std::clamp(wave, 0.0, 1.0)));
    }
  }
  Attribute a = make(name, Domain::kVertex, type, 1, values);
  a.animated = true;
  if (max_error > 0) a.max_error = {max_error};
  shot.attributes.push_back(a);
}

/// A value that moves for every domain, exact and not.
Shot with_motion(const Shape& shape, uint32_t frames) {
  Shot shot = animate(shape, frames);
  for (const Domain domain : {Domain::kVertex, Domain::kCorner, Domain::kFace, Domain::kShot}) {
    const size_t elements = shot.element_count(domain);
    std::vector<float> values;
    for (uint32_t t = 0; t < frames; ++t) {
      for (size_t e = 0; e < elements; ++e) {
        const size_t pair = e / 2;
        const double phase = 0.7 * t + 0.3 * static_cast<double>(pair);
        values.push_back(static_cast<float>(static_cast<int>(500 * std::sin(phase))) / 1000);
      }
    }
    Attribute a = make("exact", domain, ValueType::kBinary32, 1, values);
    a.animated = true;
    shot.attributes.push_back(a);
    a.name = "rough";
    a.max_error = {0.02};
    shot.attributes.push_back(a);
  }
  std::vector<uint8_t> colours(frames * 4 * shot.connectivity.vertex_count);
  for (size_t i = 0; i < colours.size(); ++i) colours[i] = static_cast<uint8_t>(i / 3);
  Attribute c = make("COLOR_0", Domain::kVertex, ValueType::kU8Normalised, 4, colours);
  c.semantic = Semantic::kColour;
  c.animated = true;
  shot.attributes.push_back(c);
  add_whole<uint16_t>(shot, "u16", ValueType::kU16, 0, 65535, 30);
  add_whole<uint16_t>(shot, "n16", ValueType::kU16Normalised, 0, 65535, 0.002);
  add_whole<int32_t>(shot, "i32", ValueType::kI32, -90000, 70000, 300);
  add_whole<int32_t>(shot, "i32 exact", ValueType::kI32, -(1 << 24), 1 << 24, 0);
  return shot;
}

/// Smooth normals, and those of the faces.
void add_normals(Shot& shot) {
  Attribute vn = make("smooth", Domain::kCorner, ValueType::kBinary32, 3,
                      std::vector<float>(3 * shot.connectivity.corners.size(), 1));
  vn.semantic = Semantic::kNormal;
  vn.max_angle = 180;  // whatever they are
  shot.attributes.push_back(vn);
  std::vector<float> flat;
  for (size_t f = 0; f < shot.connectivity.face_sizes.size(); ++f) {
    float p[3][3];
    for (size_t i = 0; i < 9; ++i)
      p[i / 3][i % 3] = shot.positions[3 * shot.connectivity.corners[3 * f + i / 3] + i % 3];
    for (size_t i = 0; i < 9; ++i) {
      const size_t b = (i + 1) % 3, c = (i + 2) % 3;
      flat.push_back((p[1][b] - p[0][b]) * (p[2][c] - p[0][c]) -
                     (p[1][c] - p[0][c]) * (p[2][b] - p[0][b]));
    }
  }
  vn.name = "flat";
  vn.max_angle = 30;
  vn.assign(std::span<const float>(flat));
  shot.attributes.push_back(vn);
}

}  // namespace

std::vector<Stream> attribute_streams() {
  std::mt19937 random(2026);
  std::vector<Stream> out;
  Sequence all = sequence_of({animate(mixed_polygons(), 2), animate(fins(4), 1)});
  for (Shot& shot : all.shots) add_all(shot, random);
  all.resources.push_back({"scene.mtl", "model/mtl", {'n', 'e', 'w', 'm', 't', 'l', '\n'}});
  out.push_back(make_stream("attributes",
                            "Static attributes of every domain and type, in two shots; a resource.",
                            all, Target::kKg));
  Sequence odd = sequence_of({animate(grid(7, 6), 1)});
  std::vector<float> values;
  for (uint32_t v = 0; v < 42; ++v)
    values.push_back(v % 14 == 3 ? -0.0f : 0.125f * static_cast<float>(v));
  values[20] = std::nanf("");
  odd.shots[0].attributes.push_back(make("odd", Domain::kVertex, ValueType::kBinary32, 1, values));
  out.push_back(make_stream("attributes_exceptions", "Values that are no multiples: -0 and NaN.",
                            odd, Target::kLossless));
  out.push_back(make_stream("attributes_texture",
                            "Texture coordinates in two charts to 12 bits, three materials.",
                            sequence_of({with_texture()}), Target::kKg));
  out.push_back(make_stream("attributes_mirrored",
                            "Attributes of a body whose halves mirror each other.",
                            sequence_of({with_halves()}), Target::kKg));
  Shot creased = animate(torus(8, 6), 3);
  add_normals(creased);
  out.push_back(make_stream("attributes_normals", "Normals computed from positions; bounds.",
                            sequence_of({creased}), Target::kKg, Profile::kMain, 0, true));
  Shot turned = animate(torus(6, 5), 4);
  add_turned_normals(turned);
  out.push_back(make_stream("attributes_turned_normals",
                            "Computed normals with corrections, the same in all frames and others.",
                            sequence_of({turned}), Target::kKg, Profile::kMain, 2));
  Shot flat = animate(mixed_polygons(), 2);
  add_turned_normals(flat);
  out.push_back(make_stream("attributes_turned_flat",
                            "Corrections where triangles have no area, in the fast profile.",
                            sequence_of({flat}), Target::kKg, Profile::kFast));
  const Sequence moving = sequence_of({with_motion(mixed_polygons(), 5)});
  out.push_back(make_stream("attributes_animated",
                            "Animated attributes of every domain, in groups.", moving, Target::kKg,
                            Profile::kMain, 3));
  out.push_back(make_stream("attributes_animated_fast", "The same in the fast profile.", moving,
                            Target::kKg, Profile::kFast, 3));
  out.push_back(make_stream("attributes_animated_lossless", "The same beside lossless positions.",
                            moving, Target::kLossless));
  return out;
}

}  // namespace reeb::conformance
