#include "retrieval/thickness.h"

#include <algorithm>

#include "segmentation/nearest.h"

namespace reeb::retrieval {
namespace {

constexpr uint32_t kSamples = 2500;
constexpr size_t kDense = 3000;
constexpr int kMaxRounds = 12;
constexpr double kEnough = 1e-3;  // a ball that shrinks by a smaller part has settled
// A ball that would touch at two places seen from its centre under a smaller angle lies in a bump
// of the surface, or in noise.
constexpr double kMaxCosine = 0.7;

std::vector<Point> vertex_normals(const Surface& surface) {
  std::vector<Point> normals(surface.vertex_count(), Point::Zero());
  for (const auto& [a, b, c] : surface.triangles) {
    const Point normal =
        (surface.points[b] - surface.points[a]).cross(surface.points[c] - surface.points[a]);
    for (const uint32_t v : {a, b, c}) normals[v] += normal;
  }
  for (Point& n : normals) n.normalize();
  return normals;
}

// Vertices, and so many places between them that a coarse mesh is as dense as a fine one.
std::vector<Point> sample_points(const Surface& surface) {
  std::vector<Point> points = surface.points;
  if (points.size() >= kDense) return points;
  for (const auto& e : surface.edges)
    points.push_back(0.5 * (surface.points[e.a] + surface.points[e.b]));
  for (const auto& [a, b, c] : surface.triangles)
    points.push_back((surface.points[a] + surface.points[b] + surface.points[c]) / 3);
  return points;
}

// Radius of the ball that touches at `x`, its centre in the direction `inwards`.
double ball_radius(const std::vector<Point>& points, const segmentation::NearestPoint& nearest,
                   const Point& x, const Point& inwards, double limit) {
  double radius = limit;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Point touched = points[nearest.find(x + radius * inwards)];
    const double square = (touched - x).squaredNorm();
    const double depth = 2 * inwards.dot(touched - x);
    if (square == 0 || depth <= 0) break;
    const double smaller = square / depth;
    if (!(smaller < radius * (1 - kEnough))) break;
    const Point centre = x + smaller * inwards;
    if ((x - centre).normalized().dot((touched - centre).normalized()) > kMaxCosine) break;
    radius = smaller;
  }
  return radius;
}

// Values of sampled vertices (others negative) spread along edges, ring by ring.
void spread(const Surface& surface, std::vector<double>& values) {
  std::vector<uint32_t> queue;
  for (uint32_t v = 0; v < values.size(); ++v) {
    if (values[v] >= 0) queue.push_back(v);
  }
  for (size_t next = 0; next < queue.size(); ++next) {
    for (const uint32_t e : surface.vertex_edges[queue[next]]) {
      const uint32_t w = surface.opposite(e, queue[next]);
      if (values[w] >= 0) continue;
      values[w] = values[queue[next]];
      queue.push_back(w);
    }
  }
}

}  // namespace

std::vector<double> local_thickness(const Surface& surface, double limit) {
  const std::vector<Point> points = sample_points(surface);
  const segmentation::NearestPoint nearest(points);
  const std::vector<Point> normals = vertex_normals(surface);
  std::vector<double> thickness(surface.vertex_count(), -1.0);
  const uint32_t stride = (surface.vertex_count() + kSamples - 1) / kSamples;
  for (uint32_t v = 0; v < thickness.size(); v += stride) {
    const Point& x = surface.points[v];
    thickness[v] = std::min(ball_radius(points, nearest, x, normals[v], limit),
                            ball_radius(points, nearest, x, -normals[v], limit));
  }
  spread(surface, thickness);
  return thickness;
}

}  // namespace reeb::retrieval
