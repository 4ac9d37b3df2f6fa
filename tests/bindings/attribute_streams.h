// A stream with every part of the attribute interface, for the tests of the bindings.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/bindings/streams.h"
#include "tests/codec/attributes/samples.h"

namespace reeb::test {

using Vector = std::array<double, 3>;

/// The unit normal of a row of faces of the grid at one of its vertices: the sum over the triangles
/// of the row that have it, faces being fans.
inline Vector row_normal(const Shot& shot, uint32_t frame, size_t row, uint32_t vertex) {
  const std::span<const float> xyz = shot.frame(frame);
  Vector sum{};
  for (size_t face = 3 * row; face < 3 * row + 3; ++face) {
    const uint32_t* const corner = &shot.connectivity.corners[4 * face];
    for (size_t i = 1; i < 3; ++i) {
      const uint32_t triangle[] = {corner[0], corner[i], corner[i + 1]};
      if (std::count(triangle, triangle + 3, vertex) == 0) continue;
      Vector u, v;
      for (size_t a = 0; a < 3; ++a) {
        u[a] = double{xyz[3 * triangle[1] + a]} - double{xyz[3 * triangle[0] + a]};
        v[a] = double{xyz[3 * triangle[2] + a]} - double{xyz[3 * triangle[0] + a]};
      }
      sum[0] += u[1] * v[2] - u[2] * v[1];
      sum[1] += u[2] * v[0] - u[0] * v[2];
      sum[2] += u[0] * v[1] - u[1] * v[0];
    }
  }
  const double length = std::hypot(sum[0], sum[1], sum[2]);
  for (double& x : sum) x /= length;
  return sum;
}

/// Shot 0: a grid of 3 by 3 quadrilaterals, 3 frames. Attributes, by index: 0 "vt", u8 at corners,
/// the row of the face; 1 "usemtl", material u16 of faces; 2 "heat", animated, 2 channels at
/// vertices; 3 "vn", computed normals with hard edges between the rows. Shot 1: a tetrahedron, one
/// frame, "id" at its vertices.
inline Sequence attribute_sequence() {
  Shot sheet = animate(grid(4, 4), 3);
  std::vector<uint8_t> rows;
  std::vector<float> normals, heat;
  for (size_t i = 0; i < 36; ++i) {
    rows.push_back(static_cast<uint8_t>(i / 12));
    const Vector n = row_normal(sheet, 0, i / 12, sheet.connectivity.corners[i]);
    for (const double x : n) normals.push_back(static_cast<float>(x));
  }
  for (int i = 0; i < 3 * 16 * 2; ++i) heat.push_back(static_cast<float>(i));
  sheet.attributes = {make("vt", Domain::kCorner, ValueType::kU8, 1, rows),
                      make("usemtl", Domain::kFace, ValueType::kU16, 1,
                           std::vector<uint16_t>{1, 1, 1, 0, 0, 0, 1, 1, 1}),
                      make("heat", Domain::kVertex, ValueType::kBinary32, 2, heat),
                      make("vn", Domain::kCorner, ValueType::kBinary32, 3, normals)};
  sheet.attributes[0].semantic = Semantic::kTextureCoordinate;
  sheet.attributes[1].semantic = Semantic::kMaterial;
  sheet.attributes[1].names = {"skin", "claw"};
  sheet.attributes[2].animated = true;
  sheet.attributes[3].semantic = Semantic::kNormal;
  sheet.attributes[3].max_angle = 1e-4;  // which they keep
  Shot other = animate(tetrahedron(), 1);
  other.attributes = {
      make("id", Domain::kVertex, ValueType::kI32, 1, std::vector<int32_t>{-7, 1 << 30, 0, 5})};
  Sequence out = sequence_of({sheet, other});
  out.resources.push_back({"a.mtl", "model/mtl", {1, 2, 3}});
  return out;
}

inline const Bytes& attribute_stream() {
  static const Bytes bytes = [] {
    EncodeOptions options;
    options.target = Target::kLossless;
    options.bounds = true;
    options.effort = 1;
    return encode_or_fail(attribute_sequence(), options).bytes;
  }();
  return bytes;
}

}  // namespace reeb::test
