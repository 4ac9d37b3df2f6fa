#include "segmentation/curvature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reeb::segmentation {
namespace {

// Neighbouring triangles must run through their common edge in opposite directions; a few need not.
bool consistently_oriented(const Surface& surface) {
  std::vector<int> balance(surface.edges.size(), 0);
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t e = surface.triangle_edges[t][i];
      balance[e] += surface.edges[e].a == surface.triangles[t][i] ? 1 : -1;
    }
  }
  const auto wrong =
      std::count_if(balance.begin(), balance.end(), [](int b) { return std::abs(b) > 1; });
  return wrong * 100 <= static_cast<std::ptrdiff_t>(surface.edges.size());
}

Eigen::MatrixX3d vertex_normals(const Surface& surface) {
  Eigen::MatrixX3d normals = Eigen::MatrixX3d::Zero(surface.vertex_count(), 3);
  const Point& origin = surface.points.front();
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Point &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    const Point normal = (q - p).cross(r - p);
    volume += normal.dot(p - origin);
    for (const uint32_t v : {a, b, c}) normals.row(v) += normal.transpose();
  }
  normals.rowwise().normalize();
  return volume < 0 ? Eigen::MatrixX3d(-normals) : normals;
}

// 2 pi minus the angles around each vertex; 0 on the boundary, where it says nothing of the
// curvature.
Eigen::VectorXd angle_defects(const Surface& surface) {
  Eigen::VectorXd defect = Eigen::VectorXd::Constant(surface.vertex_count(), 2 * std::numbers::pi);
  for (const Triple& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Point u = surface.points[t[(i + 1) % 3]] - surface.points[t[i]];
      const Point w = surface.points[t[(i + 2) % 3]] - surface.points[t[i]];
      defect[t[i]] -= std::atan2(u.cross(w).norm(), u.dot(w));
    }
  }
  for (uint32_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_triangles[e].size() == 1) {
      defect[surface.edges[e].a] = defect[surface.edges[e].b] = 0;
    }
  }
  return defect;
}

void average(const Surface& surface, Eigen::VectorXd& values, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXd sum = values, count = Eigen::VectorXd::Ones(values.size());
    for (const auto [a, b] : surface.edges) {
      sum[a] += values[b];
      sum[b] += values[a];
      ++count[a];
      ++count[b];
    }
    values = sum.cwiseQuotient(count);
  }
}

}  // namespace

Eigen::VectorXd minimal_curvature(const Surface& surface, const Laplacian& laplacian, int rounds) {
  if (!consistently_oriented(surface)) return Eigen::VectorXd::Zero(surface.vertex_count());
  Eigen::MatrixX3d positions(surface.vertex_count(), 3);
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) {
    positions.row(v) = surface.points[v].transpose();
  }
  // W x = 2 H n A
  const Eigen::MatrixX3d flow = laplacian.stiffness * positions;
  Eigen::VectorXd mean = flow.cwiseProduct(vertex_normals(surface)).rowwise().sum();
  mean = 0.5 * mean.cwiseQuotient(laplacian.mass);
  Eigen::VectorXd gauss = angle_defects(surface).cwiseQuotient(laplacian.mass);
  average(surface, mean, rounds);
  average(surface, gauss, rounds);
  return mean - (mean.cwiseAbs2() - gauss).cwiseMax(0).cwiseSqrt();
}

}  // namespace reeb::segmentation
