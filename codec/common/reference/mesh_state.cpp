#include "codec/common/reference/mesh_state.h"

namespace reeb {
namespace {

void append_triangle(uint32_t a, uint32_t b, uint32_t c, std::vector<uint32_t>& triangles) {
  if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
}

}  // namespace

std::vector<uint32_t> collect_triangles(const MeshState& state) {
  std::vector<uint32_t> out;
  out.reserve(state.triangles.size() + 3 * state.listed.corners.size());
  const auto& v = state.vertex_of_point;
  for (size_t t = 0; t < state.triangles.size(); t += 3) {
    append_triangle(v[state.triangles[t]], v[state.triangles[t + 1]], v[state.triangles[t + 2]],
                    out);
  }
  const uint32_t* corner = state.listed.corners.data();
  for (const uint32_t size : state.listed.sizes) {
    for (uint32_t i = 1; i + 1 < size; ++i)
      append_triangle(corner[0], corner[i], corner[i + 1], out);
    corner += size;
  }
  return out;
}

Connectivity collect_faces(const MeshState& state, const std::vector<uint32_t>& output_index) {
  Connectivity out;
  out.vertex_count = state.vertex_count;
  out.face_sizes = state.joined.sizes;
  out.face_sizes.insert(out.face_sizes.end(), state.listed.sizes.begin(), state.listed.sizes.end());
  out.corners.reserve(state.joined.corners.size() + state.listed.corners.size());
  for (const uint32_t point : state.joined.corners)
    out.corners.push_back(output_index[state.vertex_of_point[point]]);
  for (const uint32_t vertex : state.listed.corners) out.corners.push_back(output_index[vertex]);
  return out;
}

}  // namespace reeb
