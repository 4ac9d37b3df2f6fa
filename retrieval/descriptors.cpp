#include "retrieval/descriptors.h"

#include <algorithm>
#include <cmath>

namespace reeb::retrieval {
namespace {

// Times in units of the area: a sphere's first eigenvalue is 8 pi / area.
constexpr double kFirstTime = 0.0006, kTimeFactor = 1.7783;
// Energies are logarithms of eigenvalues times the area: from about the first to the 55th.
constexpr double kFirstEnergy = 2.3026, kLastEnergy = 6.5511, kEnergyWidth = 0.45;
constexpr double kMinEigenvalue = 1e-6;  // times the area; below it the eigenvector is constant
constexpr double kMinSignature = 1e-9;
constexpr int kSources = 16;
constexpr double kMinReach = 0.02;  // over the root of the area

// Quantiles of log(sum_i filter(lambda_i area, scale) phi_i^2 area) for every scale.
template <typename Filter>
std::vector<double> filtered_quantiles(std::span<const PieceSpectrum> pieces, double area,
                                       Filter filter) {
  std::vector<double> all;
  for (int s = 0; s < kScales; ++s) {
    Weighted values;
    for (const PieceSpectrum& piece : pieces) {
      Eigen::VectorXd weights = piece.pairs.values * area;
      for (double& w : weights) w = filter(w, s);
      const Eigen::VectorXd sum = piece.pairs.vectors.array().square().matrix() * weights;
      for (Eigen::Index v = 0; v < sum.size(); ++v)
        values.emplace_back(std::log(std::max(sum[v] * area, kMinSignature)), piece.mass[v]);
    }
    const std::vector<double> found = quantiles(std::move(values), kQuantiles);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

double energy(int scale) {
  return kFirstEnergy + (kLastEnergy - kFirstEnergy) * scale / (kScales - 1);
}

double wave_filter(double lambda, int scale) {
  if (lambda <= kMinEigenvalue) return 0;
  const double distance = (energy(scale) - std::log(lambda)) / kEnergyWidth;
  return std::exp(-0.5 * distance * distance);
}

}  // namespace

std::vector<double> quantiles(Weighted values, int count) {
  std::sort(values.begin(), values.end());
  double total = 0;
  for (const auto& [value, weight] : values) total += weight;
  std::vector<double> found(count, 0.0);
  size_t at = 0;
  double before = 0;
  for (int i = 0; i < count && !values.empty(); ++i) {
    const double wanted = total * (i + 0.5) / count;
    while (at + 1 < values.size() && before + values[at].second < wanted)
      before += values[at++].second;
    found[i] = values[at].first;
  }
  return found;
}

std::vector<double> heat_quantiles(std::span<const PieceSpectrum> pieces, double area) {
  return filtered_quantiles(pieces, area, [](double lambda, int s) {
    return std::exp(-std::max(lambda, 0.0) * kFirstTime * std::pow(kTimeFactor, s));
  });
}

std::vector<double> wave_quantiles(std::span<const PieceSpectrum> pieces, double area) {
  std::array<double, kScales> total{};
  for (const PieceSpectrum& piece : pieces) {
    for (const double lambda : piece.pairs.values) {
      for (int s = 0; s < kScales; ++s) total[s] += wave_filter(lambda * area, s);
    }
  }
  return filtered_quantiles(pieces, area, [&](double lambda, int s) {
    return total[s] > 0 ? wave_filter(lambda, s) / total[s] : 0;
  });
}

Weighted straightness(const Surface& surface, const Eigen::VectorXd& mass) {
  const auto farthest = [](const std::vector<double>& d) {
    return static_cast<uint32_t>(std::max_element(d.begin(), d.end()) - d.begin());
  };
  uint32_t source = farthest(edge_distances(surface, 0, HUGE_VAL));
  std::vector<double> nearest(surface.vertex_count(), HUGE_VAL);
  Weighted values;
  for (int i = 0; i < kSources; ++i) {
    const std::vector<double> along = edge_distances(surface, source, HUGE_VAL);
    for (uint32_t v = 0; v < along.size(); ++v) {
      nearest[v] = std::min(nearest[v], along[v]);
      if (along[v] > 0)
        values.emplace_back((surface.points[v] - surface.points[source]).norm() / along[v],
                            mass[v] * along[v]);
    }
    source = farthest(nearest);
  }
  return values;
}

Weighted curvatures(const Surface& surface, const segmentation::Laplacian& laplacian,
                    const Point& centre, double unit) {
  Eigen::MatrixX3d positions(surface.vertex_count(), 3);
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) positions.row(v) = surface.points[v];
  const Eigen::MatrixX3d bend = laplacian.stiffness * positions;
  std::vector<Point> normals(surface.vertex_count(), Point::Zero());
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Point& p = surface.points[a];
    const Point normal = (surface.points[b] - p).cross(surface.points[c] - p);
    for (const uint32_t v : {a, b, c}) normals[v] += normal;
    volume += normal.dot(p - centre);
  }
  Weighted values;
  for (uint32_t v = 0; v < surface.vertex_count(); ++v) {
    // bend is 2 H n times the area of the vertex (Meyer and others, see laplacian.h).
    const double curvature = bend.row(v).norm() / (2 * laplacian.mass[v]);
    const bool outwards = bend.row(v).dot(normals[v]) * volume >= 0;
    values.emplace_back(std::asinh((outwards ? curvature : -curvature) * unit), laplacian.mass[v]);
  }
  return values;
}

Weighted reaches(const Surface& surface, const Eigen::VectorXd& mass, const Point& centre,
                 double unit) {
  Weighted values;
  for (uint32_t v = 0; v < surface.vertex_count(); ++v)
    values.emplace_back(std::log(std::max((surface.points[v] - centre).norm() / unit, kMinReach)),
                        mass[v]);
  return values;
}

Point area_centre(std::span<const Surface> surfaces) {
  Point sum = Point::Zero();
  double area = 0;
  for (const Surface& surface : surfaces) {
    for (uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const double weight = triangle_area(surface, t);
      for (const uint32_t v : surface.triangles[t]) sum += weight / 3 * surface.points[v];
      area += weight;
    }
  }
  return area > 0 ? Point(sum / area) : sum;
}

}  // namespace reeb::retrieval
