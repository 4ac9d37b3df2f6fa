#include "conformance/retrieval/variants.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/MidpointT.hh>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace reeb::conformance {
namespace {

using Map = Eigen::Map<Eigen::Matrix3Xf>;
using OpenMesh::TriMesh_ArrayKernelT;
using Mesh = TriMesh_ArrayKernelT<>;

Map points(PlainMesh& mesh) {
  return {mesh.positions.data(), 3, static_cast<Eigen::Index>(mesh.positions.size() / 3)};
}

void rotate(PlainMesh& mesh) {
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(1.1f, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  points(mesh) = (turn * points(mesh)).eval();
}

void scale(PlainMesh& mesh) { points(mesh) *= 37.5f; }

Eigen::Matrix3Xf normals(PlainMesh& mesh) {
  const Map p = points(mesh);
  Eigen::Matrix3Xf sum = Eigen::Matrix3Xf::Zero(3, p.cols());
  for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const uint32_t* v = &mesh.triangles[t];
    const Eigen::Vector3f normal = (p.col(v[1]) - p.col(v[0])).cross(p.col(v[2]) - p.col(v[0]));
    for (int k = 0; k < 3; ++k) sum.col(v[k]) += normal;
  }
  sum.colwise().normalize();
  return sum;
}

// Normally distributed by Box and Muller's formula.
void add_noise(PlainMesh& mesh, double percent) {
  std::mt19937 random(1);
  const auto uniform = [&] { return (static_cast<double>(random()) + 1) / 4294967297.0; };
  Map p = points(mesh);
  const double size = (p.rowwise().maxCoeff() - p.rowwise().minCoeff()).norm() * percent / 100;
  const Eigen::Matrix3Xf n = normals(mesh);
  for (Eigen::Index v = 0; v < p.cols(); ++v) {
    const double normal = std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform());
    p.col(v) += static_cast<float>(normal * size) * n.col(v);
  }
}

Mesh to_open_mesh(const PlainMesh& mesh) {
  Mesh out;
  for (size_t i = 0; i < mesh.positions.size(); i += 3)
    out.add_vertex({mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
  for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto corner = [&](size_t k) {
      return Mesh::VertexHandle(static_cast<int>(mesh.triangles[t + k]));
    };
    if (corner(0) != corner(1) && corner(1) != corner(2) && corner(2) != corner(0))
      out.add_face(corner(0), corner(1), corner(2));
  }
  return out;
}

PlainMesh from_open_mesh(Mesh& mesh) {
  mesh.garbage_collection();
  PlainMesh out;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    out.positions.insert(out.positions.end(), {p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces()) {
    for (const auto v : mesh.fv_range(f)) out.triangles.push_back(static_cast<uint32_t>(v.idx()));
  }
  return out;
}

void decimate_open_mesh(Mesh& mesh, size_t triangles) {
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to_faces(0, triangles);
}

void decimate(PlainMesh& mesh, size_t factor) {
  Mesh open = to_open_mesh(mesh);
  decimate_open_mesh(open, mesh.triangles.size() / 3 / factor);
  mesh = from_open_mesh(open);
}

void resample(PlainMesh& mesh) {
  Mesh open = to_open_mesh(mesh);
  OpenMesh::Subdivider::Uniform::MidpointT<Mesh>
      refine;  // whose other constructor calls what is not there yet
  refine(open, 1);
  decimate_open_mesh(open, mesh.triangles.size() / 3);
  mesh = from_open_mesh(open);
}

// Keeps the triangles that a function of their corners allows, and the vertices that these use.
template <typename Allowed>
void keep_triangles(PlainMesh& mesh, Allowed allowed) {
  PlainMesh kept;
  std::map<uint32_t, uint32_t> number;
  for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
    if (!allowed(&mesh.triangles[t])) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[t + k];
      const auto [at, added] = number.try_emplace(v, static_cast<uint32_t>(number.size()));
      if (added)
        kept.positions.insert(kept.positions.end(), &mesh.positions[3 * v],
                              &mesh.positions[3 * v] + 3);
      kept.triangles.push_back(at->second);
    }
  }
  mesh = std::move(kept);
}

void make_holes(PlainMesh& mesh) {
  constexpr size_t kHoles = 10, kVertices = 12;
  const Map p = points(mesh);
  std::vector<bool> gone(static_cast<size_t>(p.cols()), false);
  for (size_t h = 0; h < kHoles; ++h) {
    const Eigen::Index centre = static_cast<Eigen::Index>((2 * h + 1) * gone.size() / (2 * kHoles));
    std::vector<std::pair<float, Eigen::Index>> near;
    for (Eigen::Index v = 0; v < p.cols(); ++v)
      near.emplace_back((p.col(v) - p.col(centre)).squaredNorm(), v);
    std::partial_sort(near.begin(), near.begin() + kVertices, near.end());
    for (size_t i = 0; i < kVertices; ++i) gone[static_cast<size_t>(near[i].second)] = true;
  }
  keep_triangles(mesh,
                 [&](const uint32_t* v) { return !gone[v[0]] && !gone[v[1]] && !gone[v[2]]; });
}

void halve(PlainMesh& mesh) {
  const Map p = points(mesh);
  const Eigen::Vector3f centre = p.rowwise().mean();
  const Eigen::Matrix3Xf from_centre = p.colwise() - centre;
  const Eigen::Matrix3f spread = from_centre * from_centre.transpose();
  const Eigen::Vector3f axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(spread).eigenvectors().col(2);
  const Eigen::VectorXf side = from_centre.transpose() * axis;
  // The sign of an eigenvector is an accident; the side of the first vertex is none.
  const float sign = side[0] < 0 ? -1.f : 1.f;
  keep_triangles(
      mesh, [&](const uint32_t* v) { return sign * (side[v[0]] + side[v[1]] + side[v[2]]) > 0; });
}

}  // namespace

const std::vector<std::string>& variant_names() {
  static const std::vector<std::string> names{"rotated",   "scaled",      "noise_0.5",
                                              "noise_1",   "decimated_2", "decimated_10",
                                              "resampled", "holes",       "half"};
  return names;
}

bool make_variant(const std::string& name, PlainMesh& mesh) {
  if (name == "rotated")
    rotate(mesh);
  else if (name == "scaled")
    scale(mesh);
  else if (name == "noise_0.5")
    add_noise(mesh, 0.5);
  else if (name == "noise_1")
    add_noise(mesh, 1);
  else if (name == "decimated_2")
    decimate(mesh, 2);
  else if (name == "decimated_10")
    decimate(mesh, 10);
  else if (name == "resampled")
    resample(mesh);
  else if (name == "holes")
    make_holes(mesh);
  else if (name == "half")
    halve(mesh);
  else
    return false;
  return true;
}

}  // namespace reeb::conformance
