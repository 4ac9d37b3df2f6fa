#include "segmentation/laplacian.h"

#include <algorithm>
#include <cmath>

namespace reeb::segmentation {
namespace {

// Margin of the triangle inequality in units of the mean edge length.
constexpr double kMargin = 1e-4;

std::vector<double> mollified_lengths(const Surface& surface) {
  std::vector<double> lengths(surface.edges.size());
  double mean = 0;
  for (uint32_t e = 0; e < lengths.size(); ++e) mean += lengths[e] = surface.edge_length(e);
  mean /= static_cast<double>(lengths.size());
  double extra = 0;
  for (const auto& [a, b, c] : surface.triangle_edges) {
    const double longest = std::max({lengths[a], lengths[b], lengths[c]});
    const double slack = lengths[a] + lengths[b] + lengths[c] - 2 * longest;
    extra = std::max(extra, kMargin * mean - slack);
  }
  for (double& length : lengths) length += extra;
  return lengths;
}

// Corner i of a triangle lies opposite to side i.
struct Corners {
  double area;
  std::array<double, 3> cotangent;
};

Corners corners_of(const std::array<double, 3>& side) {
  const double s = 0.5 * (side[0] + side[1] + side[2]);
  Corners corners;
  corners.area = std::sqrt(s * (s - side[0]) * (s - side[1]) * (s - side[2]));
  for (int i = 0; i < 3; ++i) {
    const double a = side[i], b = side[(i + 1) % 3], c = side[(i + 2) % 3];
    corners.cotangent[i] = (b * b + c * c - a * a) / (4 * corners.area);
  }
  return corners;
}

// Part of the triangle's area that belongs to corner i: its Voronoi cell, or, in an obtuse
// triangle, half of the area for the obtuse corner and a quarter for the others.
double corner_area(const Corners& corners, const std::array<double, 3>& side, int i) {
  const auto& cot = corners.cotangent;
  if (cot[i] < 0) return corners.area / 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  if (cot[j] < 0 || cot[k] < 0) return corners.area / 4;
  return (side[j] * side[j] * cot[j] + side[k] * side[k] * cot[k]) / 8;
}

}  // namespace

Laplacian build_laplacian(const Surface& surface) {
  const std::vector<double> lengths = mollified_lengths(surface);
  Laplacian result;
  result.mass = Eigen::VectorXd::Zero(surface.vertex_count());
  std::vector<double> weight(surface.edges.size(), 0.0);
  for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const Triple& v = surface.triangles[t];
    const Triple& e = surface.triangle_edges[t];
    // Edge i joins the vertices i and i + 1, so vertex i lies opposite to edge i + 1.
    const std::array<double, 3> side = {lengths[e[1]], lengths[e[2]], lengths[e[0]]};
    const Corners corners = corners_of(side);
    for (int i = 0; i < 3; ++i) {
      weight[e[(i + 1) % 3]] += 0.5 * corners.cotangent[i];
      result.mass[v[i]] += corner_area(corners, side, i);
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(4 * surface.edges.size());
  for (uint32_t e = 0; e < surface.edges.size(); ++e) {
    const auto [a, b] = surface.edges[e];
    entries.emplace_back(a, b, -weight[e]);
    entries.emplace_back(b, a, -weight[e]);
    entries.emplace_back(a, a, weight[e]);
    entries.emplace_back(b, b, weight[e]);
  }
  result.stiffness.resize(surface.vertex_count(), surface.vertex_count());
  result.stiffness.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace reeb::segmentation
