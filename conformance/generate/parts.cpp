#include "conformance/generate/parts.h"

#include <cmath>

namespace reeb::conformance {

using namespace reeb::test;

int64_t ripple(uint32_t k, uint32_t row) {
  return static_cast<int64_t>((row * 7 + k * 5) % 11) % 3 - 1;
}

int64_t none(uint32_t, uint32_t) { return 0; }

int64_t leap(uint32_t k, uint32_t row) {
  const uint32_t i = k * 131 + row;
  if (i % 3 != 0) return ripple(k, row);
  const int64_t size = (int64_t{1} << (i / 3) % 56) + i;
  return i % 2 != 0 ? -size : size;
}

BuiltMesh mesh_of(const Shape& shape, uint32_t bits) {
  return build_mesh(shape.connectivity, on_grid(shape, bits));
}
BuiltMesh plain_mesh_of(const Shape& shape, uint32_t bits) {
  return build_mesh(shape.connectivity, on_grid(shape, bits), {.plain = true});
}

BuiltGroup plain_group(uint32_t frames, uint32_t components) {
  BuiltGroup g;
  g.header.frame_count = frames;
  g.header.component_count = components;
  g.header.quantization_step = 0.5f;
  g.coefficients = ripple;
  g.basis = ripple;
  return g;
}

BuiltGroup thesis_group(uint32_t frames) {
  BuiltGroup g = plain_group(frames, 3 * frames);
  g.header.profile = Profile::kThesis;
  g.header.axis_step[0] = 0.5f;
  g.header.axis_step[1] = 0.25f;
  g.header.axis_step[2] = 3;
  g.basis = nullptr;
  return g;
}

Bytes build_fast(BuiltGroup g, const BuiltMesh& mesh) {
  g.header.profile = Profile::kFast;
  return build_file(mesh, g);
}

Correction scattered(uint32_t row, uint32_t t, uint32_t axis) {
  const uint32_t i = row * 31 + t * 7 + axis;
  if (row % 5 == 2) return {};
  if (i % 97 == 3) return {0, true, static_cast<float>(i) * 0.37f};
  if (i % 13 == 0) return {(int64_t{1} << i % 53) - (i % 2 != 0 ? 0 : 1), false, 0};
  if (row % 7 == 3) return {t % 2 != 0 ? 1 : -2, false, 0};
  return i % 9 == 1 ? Correction{-1, false, 0} : Correction{};
}

Connectivity odd_faces() {
  Connectivity c;
  c.vertex_count = 12;
  const std::vector<std::vector<uint32_t>> faces = {
      {3}, {4, 4}, {1, 2}, {0, 1, 2}, {2, 1, 0}, {0, 1, 2}, {5, 6, 5, 7, 5, 8}, {9, 9, 9, 9}};
  for (const auto& f : faces) {
    c.face_sizes.push_back(static_cast<uint32_t>(f.size()));
    c.corners.insert(c.corners.end(), f.begin(), f.end());
  }
  c.face_sizes.push_back(300);
  for (uint32_t i = 0; i < 300; ++i) c.corners.push_back(i * 5 % 12);
  return c;
}

}  // namespace reeb::conformance
