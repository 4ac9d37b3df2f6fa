#include "tests/benchmark/perturbation.h"

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <array>
#include <map>

namespace reeb::benchmark {
namespace {

using Positions = Eigen::Map<const Eigen::Matrix3Xf>;

Positions as_matrix(std::span<const float> positions) {
  return {positions.data(), 3, static_cast<Eigen::Index>(positions.size() / 3)};
}

}  // namespace

double mean_edge_length(std::span<const float> positions, std::span<const uint32_t> triangles) {
  const Positions points = as_matrix(positions);
  double sum = 0;
  for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) {
      sum += (points.col(triangles[t + i]) - points.col(triangles[t + (i + 1) % 3])).norm();
    }
  }
  return sum / static_cast<double>(triangles.size());
}

double diagonal(std::span<const float> positions) {
  const Positions points = as_matrix(positions);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

std::vector<float> add_noise(std::span<const float> positions, double sigma, std::mt19937& random) {
  std::normal_distribution<float> noise(0, static_cast<float>(sigma));
  using Position = std::array<float, 3>;
  std::map<Position, Position> moved;
  std::vector<float> result;
  for (size_t i = 0; i + 2 < positions.size(); i += 3) {
    const Position p = {positions[i], positions[i + 1], positions[i + 2]};
    const auto [at, fresh] = moved.try_emplace(p, p);
    for (float& x : at->second) x += fresh ? noise(random) : 0;
    result.insert(result.end(), at->second.begin(), at->second.end());
  }
  return result;
}

std::vector<float> turn_and_scale(std::span<const float> positions, double factor,
                                  std::mt19937& random) {
  std::normal_distribution<float> part;
  const Eigen::Quaternionf turn =
      Eigen::Quaternionf(part(random), part(random), part(random), part(random)).normalized();
  std::vector<float> result(positions.size());
  Eigen::Map<Eigen::Matrix3Xf>(result.data(), 3, as_matrix(positions).cols()) =
      static_cast<float>(factor) * (turn.toRotationMatrix() * as_matrix(positions));
  return result;
}

DecimatedMesh decimate_to_half(std::span<const float> positions,
                               std::span<const uint32_t> triangles) {
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
  Mesh mesh;
  std::vector<Mesh::VertexHandle> handles;
  for (size_t i = 0; i + 2 < positions.size(); i += 3) {
    handles.push_back(mesh.add_vertex({positions[i], positions[i + 1], positions[i + 2]}));
  }
  for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
    mesh.add_face(handles[triangles[t]], handles[triangles[t + 1]], handles[triangles[t + 2]]);
  }
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to(mesh.n_vertices() / 2);
  mesh.garbage_collection();
  DecimatedMesh result;
  for (const auto& v : mesh.vertices()) {
    for (unsigned i = 0; i < 3; ++i) result.positions.push_back(mesh.point(v)[i]);
  }
  for (const auto& f : mesh.faces()) {
    for (const auto& v : mesh.fv_range(f)) {
      result.triangles.push_back(static_cast<uint32_t>(v.idx()));
    }
  }
  return result;
}

}  // namespace reeb::benchmark
