#include "segmentation/feature_points.h"

#include <algorithm>
#include <numeric>

#include "segmentation/diffusion.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

std::vector<uint32_t> descending_order(const Eigen::VectorXd& f) {
  std::vector<uint32_t> order(static_cast<size_t>(f.size()));
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return f[a] != f[b] ? f[a] > f[b] : a < b; });
  return order;
}

// Extrema of the distance to `source`, which is the minimum itself.
std::vector<uint32_t> extrema_from(const Surface& surface, const Eigen::MatrixXd& embedding,
                                   uint32_t source, double persistence) {
  const Eigen::VectorXd distance = distances_from(embedding, source);
  std::vector<uint32_t> extrema =
      persistent_maxima(surface, distance, persistence * distance.maxCoeff());
  extrema.push_back(source);
  return extrema;
}

}  // namespace

std::vector<uint32_t> persistent_maxima(const Surface& surface, const Eigen::VectorXd& f,
                                        double persistence) {
  // Superlevel sets grow from the top; where two of them meet, the lower peak ends.
  const std::vector<uint32_t> order = descending_order(f);
  UnionFind sets(surface.vertex_count());
  std::vector<bool> reached(surface.vertex_count(), false);
  std::vector<uint32_t> peaks;
  for (const uint32_t v : order) {
    reached[v] = true;
    uint32_t top = v;
    for (const uint32_t e : surface.vertex_edges[v]) {
      const uint32_t w = surface.opposite(e, v);
      if (!reached[w]) continue;
      uint32_t other = sets.find(w);
      if (other == top) continue;
      // The representative of a set is its peak; the higher one stays.
      if (top == v || f[other] > f[top] || (f[other] == f[top] && other < top))
        std::swap(top, other);
      if (other != v && f[other] - f[v] >= persistence) peaks.push_back(other);
      sets.unite(top, other);
    }
  }
  peaks.push_back(order.front());
  std::sort(peaks.begin(), peaks.end());
  peaks.erase(std::unique(peaks.begin(), peaks.end()), peaks.end());
  return peaks;
}

std::array<uint32_t, 2> farthest_pair(const Eigen::MatrixXd& embedding) {
  constexpr int kMaxJumps = 20;
  Eigen::Index from = 0, to = 0;
  embedding.colwise().squaredNorm().maxCoeff(&from);
  double longest = -1;
  for (int jump = 0; jump < kMaxJumps; ++jump) {
    const double distance = distances_from(embedding, static_cast<uint32_t>(from)).maxCoeff(&to);
    if (distance <= longest) break;
    longest = distance;
    std::swap(from, to);
  }
  return {static_cast<uint32_t>(from), static_cast<uint32_t>(to)};
}

std::vector<uint32_t> feature_points(const Surface& surface, const Eigen::MatrixXd& embedding,
                                     double persistence, double radius) {
  const auto [v1, v2] = farthest_pair(embedding);
  const std::vector<uint32_t> first = extrema_from(surface, embedding, v1, persistence);
  const std::vector<uint32_t> second = extrema_from(surface, embedding, v2, persistence);
  std::vector<uint32_t> features;
  std::vector<bool> covered(surface.vertex_count(), false);
  for (const uint32_t v : first) {
    if (covered[v]) continue;
    const std::vector<double> distance = edge_distances(surface, v, radius);
    const bool confirmed = std::any_of(second.begin(), second.end(),
                                       [&](uint32_t w) { return distance[w] <= radius; });
    if (!confirmed) continue;
    features.push_back(v);
    for (uint32_t w = 0; w < distance.size(); ++w) {
      if (distance[w] <= radius) covered[w] = true;
    }
  }
  std::sort(features.begin(), features.end());
  return features;
}

}  // namespace reeb::segmentation
