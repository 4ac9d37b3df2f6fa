// Small meshes, odd ones among them.
#pragma once

#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

struct TestMesh {
  std::string name;
  Connectivity connectivity;
  std::vector<float> positions;
};

inline TestMesh test_mesh(const std::string& name, std::vector<float> positions,
                          const std::vector<std::vector<uint32_t>>& faces) {
  TestMesh mesh{name, {}, std::move(positions)};
  mesh.connectivity.vertex_count = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (const auto& face : faces) {
    mesh.connectivity.face_sizes.push_back(static_cast<uint32_t>(face.size()));
    mesh.connectivity.corners.insert(mesh.connectivity.corners.end(), face.begin(), face.end());
  }
  return mesh;
}

inline std::vector<float> square() { return {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5f}; }

/// Two triangles, as every reader takes them.
inline TestMesh plain_mesh() { return test_mesh("plain", square(), {{0, 1, 2}, {0, 2, 3}}); }

/// What comes from users and breaks a half-edge structure.
inline std::vector<TestMesh> odd_meshes() {
  const std::vector<float> five{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  return {
      test_mesh("isolated vertices", {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 7, 7, 7}, {{1, 2, 3}}),
      test_mesh("duplicate vertices", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0},
                {{0, 1, 2}, {4, 2, 3}}),
      test_mesh("degenerate faces", square(), {{0, 1, 2}, {0, 0, 2}, {3, 3, 3}, {0, 2, 3}}),
      test_mesh("three faces at an edge", five, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),
      test_mesh("two fans at a vertex", {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0},
                {{0, 1, 2}, {0, 3, 4}}),
      test_mesh("a face listed twice", square(), {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}),
      test_mesh("faces of opposite sense", square(), {{0, 1, 2}, {0, 3, 2}}),
      test_mesh("polygons", {0, 0, 0, 2, 0, 0, 3, 1, 0, 2, 2, 0, 0, 2, 0, 1, 3, 1},
                {{0, 1, 2, 3, 4}, {4, 3, 5}}),
      test_mesh("no faces", square(), {}),
      test_mesh("exact floats",
                {1e-45f, -0.0f, 3.4028235e38f, 0.1f, 16777217.0f, 1.17549435e-38f, 1 / 3.0f,
                 -123456.789f, 5e-39f},
                {{0, 1, 2}}),
  };
}

}  // namespace reeb::tools
