#include "retrieval/unfolding.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "segmentation/laplacian.h"

namespace reeb::retrieval {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Corners = Eigen::Matrix<double, 2, 3>;

constexpr double kMinWeight = 0.01;  // where weights are made positive; a typical one is 0.5

// Weights of the edges.
std::vector<double> cotangent_weights(const Surface& surface, const SparseMatrix& stiffness) {
  std::vector<double> weights;
  for (const auto& e : surface.edges) weights.push_back(-stiffness.coeff(e.a, e.b));
  return weights;
}

// Minimises the sum of weight (x_b - x_a - step)^2 over the edges (a, b), some x being fixed.
class Relaxation {
 public:
  Relaxation(const Surface& surface, const std::vector<double>& weights,
             const std::vector<bool>& fixed)
      : surface_(surface), weights_(weights), row_(surface.vertex_count(), kNone) {
    for (uint32_t v = 0; v < row_.size(); ++v) {
      if (!fixed[v]) row_[v] = rows_++;
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (uint32_t e = 0; e < weights.size(); ++e) {
      const uint32_t a = row_[surface.edges[e].a], b = row_[surface.edges[e].b];
      if (a != kNone) entries.emplace_back(a, a, weights[e]);
      if (b != kNone) entries.emplace_back(b, b, weights[e]);
      if (a == kNone || b == kNone) continue;
      entries.emplace_back(a, b, -weights[e]);
      entries.emplace_back(b, a, -weights[e]);
    }
    SparseMatrix matrix(rows_, rows_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (rows_ > 0) solver_.compute(matrix);
  }

  bool ok() const { return rows_ == 0 || solver_.info() == Eigen::Success; }

  /// `x` has the fixed values; `steps` is per edge, or empty.
  void solve(Eigen::VectorXd& x, const std::vector<double>& steps) const {
    if (rows_ == 0) return;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(rows_);
    for (uint32_t e = 0; e < weights_.size(); ++e) {
      const auto [a, b] = surface_.edges[e];
      const double step = steps.empty() ? 0 : steps[e];
      if (row_[a] != kNone) right[row_[a]] += weights_[e] * ((row_[b] == kNone ? x[b] : 0) - step);
      if (row_[b] != kNone) right[row_[b]] += weights_[e] * ((row_[a] == kNone ? x[a] : 0) + step);
    }
    const Eigen::VectorXd solution = solver_.solve(right);
    for (uint32_t v = 0; v < row_.size(); ++v) {
      if (row_[v] != kNone) x[v] = solution[row_[v]];
    }
  }

 private:
  const Surface& surface_;
  const std::vector<double>& weights_;
  std::vector<uint32_t> row_;
  uint32_t rows_ = 0;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

std::vector<Corners> gather_corners(const Surface& surface, const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& y) {
  std::vector<Corners> corners(surface.triangles.size());
  for (size_t t = 0; t < corners.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = surface.triangles[t][k];
      corners[t].col(k) << x[v], y[v];
    }
  }
  return corners;
}

bool unfold_disc(const Patch& patch, const std::vector<double>& weights, Unfolding& out) {
  const Surface& surface = patch.surface;
  const Loop& rim = patch.boundaries[0];
  const double length = loop_length(surface, rim);
  if (!(length > 0)) return false;
  std::vector<bool> fixed(surface.vertex_count(), false);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(surface.vertex_count()), y = x;
  double along = 0;
  for (size_t i = 0; i < rim.size(); ++i) {
    const double angle = 2 * std::numbers::pi * along / length;
    fixed[rim[i]] = true;
    x[rim[i]] = std::cos(angle);
    y[rim[i]] = std::sin(angle);
    along += (surface.points[rim[i]] - surface.points[rim[(i + 1) % rim.size()]]).norm();
  }
  const Relaxation relaxation(surface, weights, fixed);
  if (!relaxation.ok()) return false;
  relaxation.solve(x, {});
  relaxation.solve(y, {});
  out.corners = gather_corners(surface, x, y);
  return x.allFinite() && y.allFinite();
}

// Triangles from one boundary to the other, each beside the next, and the edges that they are
// entered by and left through.
std::vector<uint32_t> crossed_edges(const Patch& patch) {
  const Surface& surface = patch.surface;
  std::vector<int> side(surface.edges.size(), -1);  // number of the boundary
  std::vector<int> loop_of(surface.vertex_count(), -1);
  for (int b = 0; b < 2; ++b) {
    for (const uint32_t v : patch.boundaries[b]) loop_of[v] = b;
  }
  std::vector<uint32_t> from(surface.triangles.size(), kNone);  // the edge it was entered by
  std::vector<uint32_t> queue;
  for (uint32_t e = 0; e < side.size(); ++e) {
    if (surface.edge_triangles[e].size() != 1) continue;
    side[e] = loop_of[surface.edges[e].a];
    const uint32_t t = surface.edge_triangles[e][0];
    if (side[e] != 0 || from[t] != kNone) continue;
    from[t] = e;
    queue.push_back(t);
  }
  for (size_t next = 0; next < queue.size(); ++next) {
    const uint32_t t = queue[next];
    for (const uint32_t e : surface.triangle_edges[t]) {
      if (side[e] == 1) {
        std::vector<uint32_t> path{e};
        for (uint32_t at = t; path.back() != from[at];) {
          path.push_back(from[at]);
          if (side[from[at]] == 0) break;
          const auto sides = surface.edge_triangles[from[at]];
          at = sides[0] == at ? sides[1] : sides[0];
        }
        return path;
      }
      for (const uint32_t other : surface.edge_triangles[e]) {
        if (from[other] != kNone) continue;
        from[other] = e;
        queue.push_back(other);
      }
    }
  }
  return {};
}

// One turn along every loop about the axis: a step of 1 over each of the crossed edges, from the
// one side of the path to the other.
std::vector<double> seam_steps(const Surface& surface, const std::vector<uint32_t>& crossed) {
  std::vector<double> steps(surface.edges.size(), 0);
  if (crossed.empty()) return steps;
  uint32_t left = surface.edges[crossed[0]].a, right = surface.edges[crossed[0]].b;
  for (const uint32_t e : crossed) {
    const auto [a, b] = surface.edges[e];
    if (left == a || right == b) {
      left = a;
      right = b;
    } else {
      left = b;
      right = a;
    }
    steps[e] = left == a ? 1 : -1;
  }
  return steps;
}

// Corners of a triangle at the seam are brought together.
void close_seam(const Surface& surface, const std::vector<double>& steps,
                std::vector<Corners>& corners) {
  for (uint32_t t = 0; t < corners.size(); ++t) {
    for (int k = 1; k < 3; ++k) {
      const uint32_t a = surface.triangles[t][0], b = surface.triangles[t][k];
      for (const uint32_t e : surface.triangle_edges[t]) {
        if (surface.edges[e].a == a && surface.edges[e].b == b) corners[t](1, k) -= steps[e];
        if (surface.edges[e].a == b && surface.edges[e].b == a) corners[t](1, k) += steps[e];
      }
    }
  }
}

double dirichlet_energy(const Surface& surface, const std::vector<double>& weights,
                        const Eigen::VectorXd& u) {
  double energy = 0;
  for (uint32_t e = 0; e < weights.size(); ++e) {
    const double step = u[surface.edges[e].b] - u[surface.edges[e].a];
    energy += weights[e] * step * step;
  }
  return energy;
}

bool unfold_annulus(const Patch& patch, const std::vector<double>& weights, Unfolding& out) {
  const Surface& surface = patch.surface;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(surface.vertex_count()), w = u;
  std::vector<bool> fixed(surface.vertex_count(), false);
  for (size_t b = 0; b < 2; ++b) {
    for (const uint32_t v : patch.boundaries[b]) {
      fixed[v] = true;
      u[v] = static_cast<double>(b);
    }
  }
  const Relaxation across(surface, weights, fixed);
  if (!across.ok()) return false;
  across.solve(u, {});
  const double energy = dirichlet_energy(surface, weights, u);
  if (!(energy > 0)) return false;
  out.height = 1 / energy;
  u *= out.height;

  fixed.assign(surface.vertex_count(), false);
  fixed[patch.boundaries[0][0]] = true;
  const Relaxation around(surface, weights, fixed);
  if (!around.ok()) return false;
  const std::vector<double> steps = seam_steps(surface, crossed_edges(patch));
  around.solve(w, steps);
  out.corners = gather_corners(surface, u, w);
  close_seam(surface, steps, out.corners);
  return u.allFinite() && w.allFinite();
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Which side of an edge, from its a to its b, the rest of a triangle lies on.
double side_of(const Surface& surface, const Corners& corners, uint32_t triangle, uint32_t edge) {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = a, c = a;
  for (int k = 0; k < 3; ++k) {
    const uint32_t v = surface.triangles[triangle][k];
    (v == surface.edges[edge].a ? a : v == surface.edges[edge].b ? b : c) = corners.col(k);
  }
  return cross(b - a, c - a);
}

// Two triangles on the same side of their common edge.
bool folds(const Surface& surface, const std::vector<Corners>& corners) {
  for (uint32_t e = 0; e < surface.edges.size(); ++e) {
    const auto sides = surface.edge_triangles[e];
    if (sides.size() != 2) continue;
    const double s = side_of(surface, corners[sides[0]], sides[0], e);
    const double t = side_of(surface, corners[sides[1]], sides[1], e);
    if (s * t > 0) return true;
  }
  return false;
}

}  // namespace

bool unfold(const Patch& patch, Unfolding& out) {
  const auto attempt = [&](const std::vector<double>& weights) {
    return patch.is_disc() ? unfold_disc(patch, weights, out) : unfold_annulus(patch, weights, out);
  };
  std::vector<double> weights =
      cotangent_weights(patch.surface, segmentation::build_laplacian(patch.surface).stiffness);
  if (attempt(weights) && !folds(patch.surface, out.corners)) return true;
  for (double& w : weights) w = std::max(w, kMinWeight);
  return attempt(weights);
}

}  // namespace reeb::retrieval
