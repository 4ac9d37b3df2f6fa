#include "conformance/rd/sted.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace reeb::conformance {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;

/// Edges of all faces, each once.
std::vector<Edge> edges_of(const Connectivity& mesh) {
  std::vector<Edge> edges;
  size_t begin = 0;
  for (const uint32_t size : mesh.face_sizes) {
    for (uint32_t i = 0; i < size; ++i) {
      const uint32_t a = mesh.corners[begin + i];
      const uint32_t b = mesh.corners[begin + (i + 1) % size];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
    begin += size;
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Standard deviation of weighted values.
struct Spread {
  double weight = 0;
  double sum = 0;
  double squares = 0;

  void add(double value, double w) {
    weight += w;
    sum += w * value;
    squares += w * value * value;
  }
  double deviation() const {
    if (weight <= 0) return 0;
    const double mean = sum / weight;
    return std::sqrt(std::max(0.0, squares / weight - mean * mean));
  }
};

double squared_distance(const float* a, const float* b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return sum;
}

/// Adds an edge whose length was `original` and is `decoded`.
void add_edge(Spread& spread, double original, double decoded) {
  if (original > 0) spread.add(std::abs(original - decoded) / original, original);
}

/// Mean over the vertices of frame t; a ratio of lengths, so no scale matters.
double spatial_part(const std::vector<Edge>& edges, const float* a, const float* b,
                    std::vector<Spread>& around) {
  std::fill(around.begin(), around.end(), Spread{});
  for (const auto& [i, j] : edges) {
    const double original = std::sqrt(squared_distance(a + 3 * i, a + 3 * j));
    const double decoded = std::sqrt(squared_distance(b + 3 * i, b + 3 * j));
    add_edge(around[i], original, decoded);
    add_edge(around[j], original, decoded);
  }
  double sum = 0;
  for (const Spread& s : around) sum += s.deviation();
  return sum / static_cast<double>(around.size());
}

/// Lengths of the edges of vertex v from each frame to the next, in diagonals.
std::vector<double> temporal_lengths(const float* positions, const Shot& shot, uint32_t v,
                                     double diagonal, double frame_distance) {
  const size_t stride = size_t{shot.connectivity.vertex_count} * 3;
  std::vector<double> lengths(shot.frame_count - 1);
  for (size_t t = 0; t < lengths.size(); ++t) {
    const float* here = positions + t * stride + size_t{v} * 3;
    const double squared = squared_distance(here, here + stride) / (diagonal * diagonal);
    lengths[t] = std::sqrt(frame_distance * frame_distance + squared);
  }
  return lengths;
}

/// Mean over the frame steps of one vertex.
double temporal_part(const std::vector<double>& original, const std::vector<double>& decoded) {
  double sum = 0;
  for (size_t t = 0; t < original.size(); ++t) {
    Spread spread;
    const size_t end = std::min(original.size(), t + 2);
    for (size_t i = t > 0 ? t - 1 : 0; i < end; ++i) add_edge(spread, original[i], decoded[i]);
    sum += spread.deviation();
  }
  return sum / static_cast<double>(original.size());
}

}  // namespace

Sted spatio_temporal_edge_difference(const Shot& original, std::span<const float> decoded,
                                     double diagonal, const StedOptions& options) {
  Sted out;
  const uint32_t vertices = original.connectivity.vertex_count;
  const std::vector<Edge> edges = edges_of(original.connectivity);
  std::vector<Spread> around(vertices);
  for (uint32_t t = 0; t < original.frame_count; ++t) {
    const size_t at = size_t{t} * vertices * 3;
    out.spatial += spatial_part(edges, original.positions.data() + at, decoded.data() + at, around);
  }
  out.spatial /= original.frame_count;
  if (original.frame_count > 1 && diagonal > 0) {
    for (uint32_t v = 0; v < vertices; ++v) {
      const auto lengths = [&](const float* positions) {
        return temporal_lengths(positions, original, v, diagonal, options.frame_distance);
      };
      out.temporal +=
          temporal_part(lengths(original.positions.data()), lengths(decoded.data())) / vertices;
    }
  }
  out.combined = std::hypot(out.spatial, options.temporal_weight * out.temporal);
  return out;
}

}  // namespace reeb::conformance
